"""Candidates that run beside what jobs ask for."""
