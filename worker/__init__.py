"""Runs jobs. The one place where the wire schema of `jobkit` becomes options of `quadpatch`."""
