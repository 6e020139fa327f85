"""Writing a mesh from another format as 3MF.

One object holds the measured and the invented triangles; the invented ones carry `hole` and `confidence` in the
namespace `urn:quadpatch`. The unit is the scan's where it states one that 3MF knows, else the millimetre, which is what
3MF takes for granted.

Tested in `tests/quadpatch/formats/test_conversion.py`.
"""

import io
import zipfile

import numpy as np

from quadpatch.formats.merged_scene import MergedScene
from quadpatch.formats.text import to_words

_UNITS = ("micron", "millimeter", "centimeter", "inch", "foot", "meter")
_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_MATERIAL = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
_HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
_TYPES = (
    _HEAD + '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
)
_RELATIONS = (
    _HEAD + '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)
# Zip entries carry a time; a fixed one keeps equal meshes equal bytes.
_TIME = (1980, 1, 1, 0, 0, 0)


def encode_as_threemf(scene: MergedScene) -> bytes:
    """Encode as a 3MF package."""
    unit = scene.unit if scene.unit in _UNITS else "millimeter"
    colours = scene.vertex_attributes.colours
    group, default = "", ""
    if colours is not None:
        tints = ["#" + bytes(row).hex().upper() for row in np.rint(colours).astype(np.uint8).tolist()]
        group = '<m:colorgroup id="2">' + "".join(f'<m:color color="{tint}"/>' for tint in tints) + "</m:colorgroup>"
        default = ' pid="2" pindex="0"'
    columns = [to_words(column) for column in scene.vertices.T]
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in zip(*columns, strict=True))
    model = (
        f'{_HEAD}<model unit="{unit}" xml:lang="en-US" xmlns="{_CORE}" xmlns:m="{_MATERIAL}" '
        f'xmlns:q="urn:quadpatch"><resources>{group}<object id="1" type="model"{default}><mesh>'
        f"<vertices>{vertices}</vertices><triangles>{_triangles(scene)}</triangles>"
        '</mesh></object></resources><build><item objectid="1"/></build></model>'
    )
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as target:
        for name, text in (("[Content_Types].xml", _TYPES), ("_rels/.rels", _RELATIONS), ("3D/3dmodel.model", model)):
            entry = zipfile.ZipInfo(name, _TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            target.writestr(entry, text)
    return packed.getvalue()


def _triangles(scene: MergedScene) -> str:
    text = []
    for row, (a, b, c) in enumerate(scene.triangles.tolist()):
        material = f' pid="2" p1="{a}" p2="{b}" p3="{c}"' if scene.vertex_attributes.colours is not None else ""
        mark = ""
        if row >= scene.n_measured:
            mark = f' q:hole="{scene.triangle_hole_id[row]}" q:confidence="{scene.triangle_confidence[row]:.6g}"'
        text.append(f'<triangle v1="{a}" v2="{b}" v3="{c}"{material}{mark}/>')
    return "".join(text)
