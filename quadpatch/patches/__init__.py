"""Patches: seed points, height maps over their frames, and what vertices they show."""
