"""Sound files of all formats, to be mutated: some made here, others real ones where they lie beside this repository."""

import io
import json
from pathlib import Path

import numpy as np
import trimesh

from tests.quadpatch.shapes import open_grid, punched

SHARED = Path(__file__).resolve().parents[3] / "shared"
FORMATS = ("ply", "stl", "obj", "off", "glb", "gltf", "3mf")
# Larger ones take longer to repair than they are worth here.
MOST_BYTES = 110_000


def made() -> dict[str, bytes]:
    """Make a sheet with a hole in every format, text and binary where there are both; by name."""
    mesh = punched(open_grid(12), (0.0, 0.0, 0.0), radius=0.3)
    sheet = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    return {
        "sheet.ply": bytes(sheet.export(file_type="ply")),
        "sheet_text.ply": bytes(sheet.export(file_type="ply", encoding="ascii")),
        "sheet.stl": bytes(sheet.export(file_type="stl")),
        "sheet_text.stl": str(sheet.export(file_type="stl_ascii")).encode(),
        "sheet.obj": b"o sheet\nmtllib a.mtl\nusemtl clay\n" + str(sheet.export(file_type="obj")).encode(),
        "sheet.off": str(sheet.export(file_type="off")).encode(),
        "sheet.glb": bytes(sheet.export(file_type="glb")),
        "sheet.gltf": _gltf(sheet),
        "sheet.3mf": bytes(sheet.export(file_type="3mf")),
    }


def _gltf(sheet: trimesh.Trimesh) -> bytes:
    """Write a glTF file that holds its buffers itself."""
    import base64  # noqa: PLC0415 - this function alone

    files = trimesh.exchange.gltf.export_gltf(sheet.scene())
    tree = json.load(io.BytesIO(files.pop("model.gltf")))
    for buffer in tree["buffers"]:
        buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(files[buffer["uri"]]).decode()
    return json.dumps(tree).encode()


def real() -> dict[str, bytes]:
    """Return the small files of ../shared, by name; none where it is missing."""
    paths = [path for folder in ("inputs", "cases") for path in sorted((SHARED / folder).rglob("*"))]
    chosen = [path for path in paths if path.is_file() and path.suffix.lower()[1:] in FORMATS]
    return {str(path.relative_to(SHARED)): path.read_bytes() for path in chosen if path.stat().st_size <= MOST_BYTES}


def drawn(files: dict[str, bytes], rng: np.random.Generator) -> tuple[str, bytes]:
    """Draw a format, then a file of that format."""
    by_format = {kind: sorted(name for name in files if name.lower().endswith("." + kind)) for kind in FORMATS}
    kinds = [kind for kind, names in by_format.items() if names]
    names = by_format[kinds[int(rng.integers(len(kinds)))]]
    name = names[int(rng.integers(len(names)))]
    return name, files[name]
