"""Engines: child processes that read meshes, their limits and confinement, and the process that forks them."""
