"""Restoring vertices whose positions are missing."""
