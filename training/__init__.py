"""Learns models, evaluates them on held-out meshes, and publishes them."""
