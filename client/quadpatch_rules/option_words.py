"""Words that options may have: of the method, on the wire, and on the command line of the client."""

from typing import Literal

# How a model's patches become surface: `default` is this project's own way, `paper` that of the paper, step by step.
Recipe = Literal["default", "paper"]
# How much the method `auto` tries: `fast` geometry alone, `standard` models that are ready in seconds, `best` also a
# network that is fitted to the mesh, which takes a minute.
Effort = Literal["fast", "standard", "best"]
# The paper's two kinds of patches, in units of the object's longest side: 0.03 with 16 bins, 0.06 with 24.
Preset = Literal["type1", "type2"]
# What says where missing vertices lie: the triangles around them, or a Poisson surface as well.
RestorationBase = Literal["mesh", "poisson"]
# Formats in which a mesh comes back.
OutputFormat = Literal["ply", "stl", "obj", "off", "glb", "3mf"]
# How new vertices get colours: carried on from the surroundings where that is better, or spread from the rim.
Colours = Literal["auto", "harmonic"]
# Units of length, as 3MF names them.
LengthUnit = Literal["micron", "millimeter", "centimeter", "meter", "inch", "foot"]
# What a mesh carries besides its shape, where it is written in another format than its own.
CarriedAttribute = Literal["colours", "normals", "texture_coordinates"]
# What the colours of invented surface say in pictures: that it is invented, or how sure it is.
Tint = Literal["invented", "confidence"]
