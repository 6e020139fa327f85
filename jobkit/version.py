"""The version of the package, which results name; that of the HTTP contract is in its paths."""

from importlib.metadata import version

VERSION = version("quadpatch")
