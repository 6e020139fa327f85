"""Colours of new vertices: the texture around a hole is carried on over its fill."""
