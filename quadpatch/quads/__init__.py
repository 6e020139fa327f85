"""Quad mesh of the smoothed mesh, and the reference frames it gives."""
