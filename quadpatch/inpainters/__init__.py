"""Models that complete height maps."""
