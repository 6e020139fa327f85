"""Repair quality on meshes whose truth is known: the experiments behind ``docs/results.md``."""
