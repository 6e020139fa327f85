"""Words that options of a job may have, on the wire and on the command line of the client."""

from typing import Literal

# How the model is put to use: our own way, or that of the paper.
Recipe = Literal["default", "paper"]
# The paper's two kinds of patches.
Preset = Literal["type1", "type2"]
# What says where missing vertices lie: the triangles around them, or a Poisson surface as well.
RestorationBase = Literal["mesh", "poisson"]
# Formats in which a mesh comes back.
OutputFormat = Literal["ply", "stl", "obj", "off", "glb", "3mf"]
