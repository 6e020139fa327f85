"""Geometric hole filling: triangulate, refine, fair."""
