"""Before/after pictures of a repair, drawn by casting rays."""

from quadpatch.picture.sheet import render_before_after

__all__ = ["render_before_after"]
