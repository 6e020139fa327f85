"""3MF packages written by hand."""

import io
import zipfile

from quadpatch.formats.scan import Scan

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
HEAD = (
    f'<?xml version="1.0" encoding="UTF-8"?>\n<model unit="inch" xmlns="{CORE}" '
    'xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02" '
    'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06">\n'
)
RELATIONS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="rel0" '
    'Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)


def package(model: str, **others: str) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as target:
        target.writestr("_rels/.rels", RELATIONS)
        target.writestr("3D/3dmodel.model", model)
        for name, text in others.items():
            target.writestr(f"3D/{name}.model", text)
        target.writestr("Metadata/thumbnail.png", b"\x89PNG not looked at")
    return packed.getvalue()


def mesh_text(scan: Scan, prefix: str = "", material: str = "") -> str:
    vertices = "".join(f'<{prefix}vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in scan.vertices.tolist())
    triangles = "".join(
        f'<{prefix}triangle v1="{a}" v2="{b}" v3="{c}"{material}/>' for a, b, c in scan.triangles.tolist()
    )
    return (
        f"<{prefix}mesh>\n<{prefix}vertices>{vertices}</{prefix}vertices><{prefix}triangles>{triangles}"
        f"</{prefix}triangles></{prefix}mesh>"
    )


def model(resources: str, items: str) -> str:
    return f"{HEAD}<resources>{resources}</resources><build>{items}</build></model>"
