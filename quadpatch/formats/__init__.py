"""Mesh files: reading them, and handing them back with what a repair adds."""
