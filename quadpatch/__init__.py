"""Repairs holes in 3D scans by learned height-map patches on a quad mesh of the smoothed surface."""
