"""Texture images of new surface: a page of its own, painted with the texture around the holes carried on."""
