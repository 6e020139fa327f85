"""Batches: jobs that are started together, and what happens to them as a whole."""
