"""What the method loads when it first needs it, loaded by the fork server beforehand: a fork has it at once.

An engine that loaded it itself would spend its own time on it, in every fork again. pymeshlab and torch stay out: they
are large, and few jobs need them.

Tested in `tests/worker/engine/test_preloading.py`.
"""

# ruff: noqa: F401  nothing here is used, all of it is only loaded

import embreex.mesh_construction
import embreex.rtcore_scene
import manifold3d
import PIL.Image

import quadpatch.colours.continuation
import quadpatch.formats.gltf.encoder
import quadpatch.formats.gltf.reader
import quadpatch.formats.threemf.encoder
import quadpatch.formats.threemf.reader
import quadpatch.html_report.writing
import quadpatch.inpainters.dictionary
import quadpatch.inpainters.onnx_network
import quadpatch.inpainters.paper_dictionary
import quadpatch.recipes.paper
import quadpatch.textures.painting

# What Pillow loads before it writes its first file.
PIL.Image.preinit()
