"""Files of every format that has texture images, written by hand."""

import base64
import io
import json
import zipfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from PIL import Image

from quadpatch.types import FloatArray, IntArray, TriangleMesh
from tests.quadpatch.formats.threemf.packages import HEAD, RELATIONS

_TYPES = (
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
)


@dataclass(frozen=True)
class Textured:
    """A mesh with images: coordinates (m, 3, 2) of corners, v upwards, material (m,), and images by their names."""

    mesh: TriangleMesh
    coordinates: FloatArray
    material: IntArray
    images: dict[str, bytes]

    def with_image(self, data: bytes, name: str = "wood.png") -> "Textured":
        return replace(self, images={name: data})


def encoded(pixels: np.ndarray, kind: str = "PNG", mode: str | None = None) -> bytes:
    """Encode pixels as an image of some format and mode."""
    image = Image.fromarray(pixels)
    data = io.BytesIO()
    converted = image if mode is None else image.quantize(16) if mode == "P" else image.convert(mode)
    converted.save(data, kind)
    return data.getvalue()


def flat(mesh: TriangleMesh, image: bytes) -> Textured:
    """Seen from above: u along x, v along y, one image."""
    low, high = mesh.vertices.min(axis=0)[:2], mesh.vertices.max(axis=0)[:2]
    coordinates = ((mesh.vertices[:, :2] - low) / (high - low))[mesh.triangles]
    return Textured(mesh, coordinates, np.zeros(len(mesh.triangles), np.int64), {"wood.png": image})


def halved(textured: Textured) -> Textured:
    """The same in two charts with a seam where x changes its sign: the left half lies in the next copy of the image."""
    is_left = textured.mesh.vertices[textured.mesh.triangles].mean(axis=1)[:, 0] < 0
    shifted = textured.coordinates + np.array([1.0, 0.0])
    return replace(textured, coordinates=np.where(is_left[:, None, None], shifted, textured.coordinates))


def with_two_materials(textured: Textured, border: float, other: bytes) -> Textured:
    """The same with another image where x is larger than `border`."""
    is_right = textured.mesh.vertices[textured.mesh.triangles].mean(axis=1)[:, 0] > border
    return replace(textured, material=is_right.astype(np.int64), images={**textured.images, "stone.png": other})


def write_obj(folder: Path, textured: Textured) -> Path:
    for name, data in textured.images.items():
        (folder / name).write_bytes(data)
    library = "".join(f"newmtl {name[:-4]}\nKd 1 1 1\nmap_Kd {name}\nmap_Bump bump.png\n" for name in textured.images)
    (folder / "scan.mtl").write_text(library)
    lines = ["mtllib scan.mtl", *_rows("v", textured.mesh.vertices)]
    lines += _rows("vt", textured.coordinates.reshape(-1, 2))
    corner = np.arange(textured.mesh.triangles.size).reshape(-1, 3) + 1
    names = [name[:-4] for name in textured.images]
    current = -1
    for triangle, corners, material in zip(textured.mesh.triangles + 1, corner, textured.material, strict=True):
        if material != current:
            lines.append(f"usemtl {names[material]}")
            current = material
        lines.append("f " + " ".join(f"{a}/{b}" for a, b in zip(triangle, corners, strict=True)))
    (folder / "scan.obj").write_text("\n".join([*lines, ""]))
    return folder / "scan.obj"


def _rows(keyword: str, table: FloatArray) -> list[str]:
    return [" ".join([keyword, *map(repr, row)]) for row in table.tolist()]


def write_ply(folder: Path, textured: Textured, is_ascii: bool = False) -> Path:
    for name, data in textured.images.items():
        (folder / name).write_bytes(data)
    mesh, has_numbers = textured.mesh, len(textured.images) > 1
    lines = ["ply", f"format {'ascii' if is_ascii else 'binary_little_endian'} 1.0"]
    lines += [f"comment TextureFile {name}" for name in textured.images]
    lines += [f"element vertex {len(mesh.vertices)}", *[f"property double {axis}" for axis in "xyz"]]
    lines += [f"element face {len(mesh.triangles)}", "property list uchar int vertex_indices"]
    lines += ["property list uchar float texcoord", *(["property int texnumber"] if has_numbers else []), "end_header"]
    fields = [("n", "u1"), ("corners", "<i4", 3), ("m", "u1"), ("wedges", "<f4", 6)]
    rows = np.zeros(len(mesh.triangles), [*fields, *([("number", "<i4")] if has_numbers else [])])
    rows["n"], rows["corners"], rows["m"], rows["wedges"] = 3, mesh.triangles, 6, textured.coordinates.reshape(-1, 6)
    if has_numbers:
        rows["number"] = textured.material
    head = "\n".join([*lines, ""]).encode()
    if is_ascii:
        body = "".join(" ".join(map(repr, row)) + "\n" for row in mesh.vertices.tolist())
        for n, corners, m, wedges, *number in rows.tolist():
            body += " ".join(map(str, [n, *np.ravel(corners), m, *np.ravel(wedges), *number])) + "\n"
        data = head + body.encode()
    else:
        data = head + mesh.vertices.astype("<f8").tobytes() + rows.tobytes()
    (folder / "scan.ply").write_bytes(data)
    return folder / "scan.ply"


def gltf_document(textured: Textured, extra: dict[str, object] | None = None) -> tuple[dict[str, object], bytes]:
    """A document with a primitive and a material for each image, and its buffer; vertices are repeated."""
    pieces: list[bytes] = []
    views: list[dict[str, object]] = []
    accessors: list[dict[str, object]] = []

    def add(data: bytes) -> int:
        padded = data + bytes(-len(data) % 4)
        views.append({"buffer": 0, "byteOffset": sum(map(len, pieces)), "byteLength": len(data)})
        pieces.append(padded)
        return len(views) - 1

    def array(values: np.ndarray, kind: str, component: int) -> int:
        low, high = values.reshape(len(values), -1).min(axis=0), values.reshape(len(values), -1).max(axis=0)
        accessor = {"bufferView": add(values.tobytes()), "componentType": component, "count": len(values)}
        accessors.append({**accessor, "type": kind, "min": low.tolist(), "max": high.tolist()})
        return len(accessors) - 1

    primitives = []
    for number in range(len(textured.images)):
        rows = textured.material == number
        corners = textured.mesh.vertices[textured.mesh.triangles[rows]].reshape(-1, 3).astype("<f4")
        wedges = (textured.coordinates[rows].reshape(-1, 2) * np.array([1, -1]) + np.array([0, 1])).astype("<f4")
        attributes = {"POSITION": array(corners, "VEC3", 5126), "TEXCOORD_0": array(wedges, "VEC2", 5126)}
        indices = array(np.arange(len(corners), dtype="<u4"), "SCALAR", 5125)
        primitives.append({"attributes": attributes, "indices": indices, "material": number})
    images = [{"bufferView": add(data), "mimeType": "image/png"} for data in textured.images.values()]
    numbers = range(len(images))
    materials = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i, **(extra or {})}}} for i in numbers]
    document = {
        **{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}]},
        **{"meshes": [{"primitives": primitives}], "accessors": accessors, "bufferViews": views},
        **{"materials": materials, "images": images, "textures": [{"source": i} for i in numbers]},
        "buffers": [{"byteLength": sum(map(len, pieces))}],
    }
    return document, b"".join(pieces)


def write_glb(folder: Path, textured: Textured) -> Path:
    document, binary = gltf_document(textured)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    body = b"".join(
        len(data).to_bytes(4, "little") + kind + data for kind, data in ((b"JSON", text), (b"BIN\0", binary))
    )
    data = b"glTF" + (2).to_bytes(4, "little") + (len(body) + 12).to_bytes(4, "little") + body
    (folder / "scan.glb").write_bytes(data)
    return folder / "scan.glb"


def write_gltf(folder: Path, textured: Textured) -> Path:
    """Images lie in files of their own, the buffer in the document."""
    document, binary = gltf_document(textured)
    for name, data in textured.images.items():
        (folder / name).write_bytes(data)
    document["images"] = [{"uri": name} for name in textured.images]
    uri = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    document["buffers"] = [{"byteLength": len(binary), "uri": uri}]
    (folder / "scan.gltf").write_text(json.dumps(document))
    return folder / "scan.gltf"


def write_3mf(folder: Path, textured: Textured, transform: str = "") -> Path:
    resources = ""
    for number, name in enumerate(textured.images):
        rows = np.flatnonzero(textured.material == number)
        places = "".join(
            f'<m:tex2coord u="{u!r}" v="{v!r}"/>' for u, v in textured.coordinates[rows].reshape(-1, 2).tolist()
        )
        path = f'path="/3D/Textures/{name}" contenttype="image/png"'
        resources += f'<m:texture2d id="{10 * number + 1}" {path}/>'
        resources += f'<m:texture2dgroup id="{10 * number + 2}" texid="{10 * number + 1}">{places}</m:texture2dgroup>'
    place = np.zeros(len(textured.material), np.int64)
    for number in range(len(textured.images)):
        rows = np.flatnonzero(textured.material == number)
        place[rows] = 3 * np.arange(len(rows))
    vertices = "".join(f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in textured.mesh.vertices.tolist())
    triangles = "".join(
        f'<triangle v1="{a}" v2="{b}" v3="{c}" pid="{10 * m + 2}" p1="{p}" p2="{p + 1}" p3="{p + 2}"/>'
        for (a, b, c), m, p in zip(
            textured.mesh.triangles.tolist(), textured.material.tolist(), place.tolist(), strict=True
        )
    )
    resources += (
        f'<object id="99"><mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object>'
    )
    model = f'{HEAD}<resources>{resources}</resources><build><item objectid="99"{transform}/></build></model>'
    with zipfile.ZipFile(folder / "scan.3mf", "w", zipfile.ZIP_DEFLATED) as target:
        target.writestr("[Content_Types].xml", _TYPES)
        target.writestr("_rels/.rels", RELATIONS)
        target.writestr("3D/3dmodel.model", model)
        for name, data in textured.images.items():
            target.writestr(f"3D/Textures/{name}", data)
    return folder / "scan.3mf"


WRITERS: dict[str, Callable[[Path, Textured], Path]] = {
    "obj": write_obj,
    "ply": write_ply,
    "glb": write_glb,
    "gltf": write_gltf,
    "3mf": write_3mf,
}
