"""Compression: a surface as a quad mesh and sparse codes."""
