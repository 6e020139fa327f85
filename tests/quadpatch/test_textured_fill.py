"""Scans with texture images, from file to file.

So `quadpatch/formats/surface_texture.py`, `quadpatch/formats/obj_materials.py`, `quadpatch/formats/gltf/images.py`,
`quadpatch/formats/threemf/images.py` and `quadpatch/formats/ply/texture_files.py` are tested, each by its files.
"""

import io
import json
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from quadpatch.formats.reading import read_scan
from quadpatch.formats.scan import Scan
from quadpatch.formats.surface_texture import SurfaceTexture
from quadpatch.options import RepairOptions
from quadpatch.repair import repair_file
from quadpatch.textures.images import DecodedImage
from quadpatch.types import FloatArray, TriangleMesh
from tests.quadpatch.formats.textured_files import (
    WRITERS,
    Textured,
    encoded,
    flat,
    halved,
    with_two_materials,
    write_3mf,
    write_glb,
    write_gltf,
    write_obj,
    write_ply,
)
from tests.quadpatch.shapes import bumpy_plate, on_surface, punched

# Stripes along x, and another ramp along y: colours that an eye and a test can predict.
_Y, _X = np.mgrid[:96, :96] / 95.0
RAMP = np.rint(np.stack([40 + 150 * _X, 40 + 150 * (1 - _Y), np.full_like(_X, 90)], axis=2)).astype(np.uint8)
GREY = np.full((32, 32, 3), 180, np.uint8)
WHOLE = bumpy_plate(24, 2.0)
HARMONIC = RepairOptions(colours="harmonic")


def plate(*places: tuple[float, float], radius: float = 0.22) -> TriangleMesh:
    mesh = punched(WHOLE, *on_surface(WHOLE, *places), radius=radius)
    used, corners = np.unique(mesh.triangles, return_inverse=True)
    return TriangleMesh(mesh.vertices[used], corners.reshape(-1, 3).astype(np.int64))


PLATE = plate((0.5, 0.4), (-0.45, -0.4))
RAMPED = flat(PLATE, encoded(RAMP))


def repaired(path: Path, options: RepairOptions = HARMONIC, name: str = "out") -> dict[str, Any]:
    return repair_file(path, path.with_name(f"{name}{path.suffix}"), "smooth", options)


def texture_of(scan: Scan) -> SurfaceTexture:
    texture = None if scan.source is None else scan.source.surface_texture(scan)
    assert texture is not None
    return texture


def colours_of(scan: Scan, triangles: slice) -> FloatArray:
    """Colours (k, 3) at the middles of triangles, each from its own image."""
    texture = texture_of(scan)
    material = texture.material[triangles]
    middles = texture.coordinates[triangles].mean(axis=1)
    colours = np.full((len(material), 3), np.nan)
    for number in np.unique(material).tolist():
        image = texture.images[number]
        assert image is not None
        colours[material == number] = DecodedImage(image).colours_at(middles[material == number])[:, :3]
    return colours


def ramp_at(scan: Scan, triangles: slice) -> FloatArray:
    """What the ramp is at the middles of triangles."""
    low, high = PLATE.vertices.min(axis=0), PLATE.vertices.max(axis=0)
    middles = scan.vertices[scan.triangles[triangles]].mean(axis=1)
    x, y = ((middles - low) / (high - low))[:, :2].T
    return np.stack([40 + 150 * x, 40 + 150 * y, np.full_like(x, 90)], axis=1)


@pytest.mark.parametrize("shaped", [lambda textured: textured, halved], ids=["one chart", "two charts with a seam"])
@pytest.mark.parametrize("kind", WRITERS)
def test_new_triangles_of_every_format_go_on_with_the_image(
    kind: str, shaped: Callable[[Textured], Textured], tmp_path: Path
) -> None:
    # A hole over the seam, and one beside it.
    path = WRITERS[kind](tmp_path, shaped(flat(plate((0.02, 0.4), (-0.45, -0.4)), encoded(RAMP))))
    before = read_scan(path)
    report = repaired(path)
    assert report["counts"]["filled_smooth"] == 2
    assert report["texture"]["method"] == "harmonic"
    assert report["warnings"] == []
    after = read_scan(tmp_path / f"out.{kind}")
    new = slice(len(before.triangles), None)
    assert len(after.triangles) > len(before.triangles)
    # A texel is two units wide on the ramp, and samples take the nearest.
    assert np.abs(colours_of(after, new) - ramp_at(after, new)).max() < 8
    page = texture_of(after).images[-1]
    assert page is not None
    size = DecodedImage(page)
    assert all(side & (side - 1) == 0 for side in (size.width, size.height))


@pytest.mark.parametrize("kind", WRITERS)
def test_measured_texels_and_coordinates_stay_bit_for_bit(kind: str, tmp_path: Path) -> None:
    path = WRITERS[kind](tmp_path, RAMPED)
    before = read_scan(path)
    files = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    repaired(path)
    after = read_scan(tmp_path / f"out.{kind}")
    n, m = len(before.vertices), len(before.triangles)
    assert after.vertices[:n].tobytes() == before.vertices.tobytes()
    assert (after.triangles[:m] == before.triangles).all()
    old, new = texture_of(before), texture_of(after)
    assert new.coordinates[:m].tobytes() == old.coordinates.tobytes()
    assert (new.material[:m] == old.material).all()
    assert not np.isin(new.material[m:], old.material).any()
    for was, now in zip(old.images, new.images, strict=False):
        assert was is not None
        assert now is not None
        assert was.read() == now.read()
    assert {name: (tmp_path / name).read_bytes() for name in files} == files


@pytest.mark.parametrize("kind", WRITERS)
def test_the_same_bytes_come_again(kind: str, tmp_path: Path) -> None:
    path = WRITERS[kind](tmp_path, RAMPED)
    repaired(path)
    first = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    repaired(path)
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == first


@pytest.mark.parametrize("kind", WRITERS)
def test_a_hole_between_two_materials_takes_the_one_that_has_more_of_its_rim(kind: str, tmp_path: Path) -> None:
    # Most of the hole's rim lies left of the border, on the ramp.
    textured = with_two_materials(RAMPED, 0.58, encoded(GREY))
    path = WRITERS[kind](tmp_path, textured)
    report = repaired(path)
    assert report["warnings"] == []
    before, after = read_scan(path), read_scan(tmp_path / f"out.{kind}")
    m = len(before.triangles)
    texture = texture_of(after)
    assert len(np.unique(texture.material[m:])) == 1
    # Both images are painted on over it: from the ramp's red to grey.
    middles = after.vertices[after.triangles[m:]].mean(axis=1)
    colours = colours_of(after, slice(m, None))
    right = middles[:, 0] > 0.1
    assert np.ptp(colours[right, 2]) > 40


@pytest.mark.parametrize("kind", WRITERS)
def test_holes_in_two_materials_share_a_page_and_keep_their_materials(kind: str, tmp_path: Path) -> None:
    textured = with_two_materials(RAMPED, 0.0, encoded(GREY))
    path = WRITERS[kind](tmp_path, textured)
    repaired(path)
    before, after = read_scan(path), read_scan(tmp_path / f"out.{kind}")
    m = len(before.triangles)
    right = after.vertices[after.triangles[m:]].mean(axis=1)[:, 0] > 0
    colours = colours_of(after, slice(m, None))
    assert (colours[right] == 180).all()
    assert np.abs(colours[~right] - ramp_at(after, slice(m, None))[~right]).max() < 8
    if kind in ("obj", "glb", "gltf"):
        assert len(np.unique(texture_of(after).material[m:])) == 2


_DEEP = (np.arange(96 * 96).reshape(96, 96) * 7).astype(np.uint16)
_ALPHA = np.concatenate([RAMP, np.full((96, 96, 1), 128, np.uint8)], axis=2)


@pytest.mark.parametrize(
    ("image", "expected"),
    [
        (encoded(RAMP, "JPEG"), None),
        (encoded(RAMP, "WEBP"), None),
        (encoded(RAMP, "BMP"), None),
        (encoded(RAMP, "TIFF"), None),
        (encoded(np.full((96, 96, 3), 77, np.uint8), "PNG", "P"), (77, 77, 77)),
        (encoded(np.full((96, 96), 77, np.uint8)), (77, 77, 77)),
        (encoded(np.full((96, 96), 77 * 256 + 200, np.uint16)), (77, 77, 77)),
        (encoded(np.full((96, 96, 3), 77, np.uint8), "JPEG", "CMYK"), (77, 77, 77)),
    ],
    ids=["jpeg", "webp", "bmp", "tiff", "palette", "grey", "16 bit", "cmyk"],
)
def test_images_of_other_kinds_are_carried_on(
    image: bytes, expected: tuple[int, int, int] | None, tmp_path: Path
) -> None:
    path = write_glb(tmp_path, RAMPED.with_image(image))
    report = repaired(path)
    assert report["texture"]["problems"] == []
    after = read_scan(tmp_path / "out.glb")
    new = slice(len(read_scan(path).triangles), None)
    true = ramp_at(after, new) if expected is None else np.array(expected)
    assert np.abs(colours_of(after, new) - true).max() < 12


def test_a_page_has_the_alpha_of_its_surroundings(tmp_path: Path) -> None:
    path = write_glb(tmp_path, RAMPED.with_image(encoded(_ALPHA)))
    repaired(path)
    page = texture_of(read_scan(tmp_path / "out.glb")).images[-1]
    assert page is not None
    pixels = np.asarray(Image.open(io.BytesIO(page.read())))
    assert pixels.shape[2] == 4
    assert (pixels[..., 3] == 128).all()


def _bomb() -> bytes:
    """A PNG of a few kilobytes that says it has 40,000 by 40,000 pixels."""
    small = encoded(RAMP)
    at = small.index(b"IHDR") + 4
    import zlib  # noqa: PLC0415

    head = (40_000).to_bytes(4, "big") * 2 + small[at + 8 : at + 13]
    return small[:at] + head + zlib.crc32(b"IHDR" + head).to_bytes(4, "big") + small[at + 17 :]


@pytest.mark.parametrize(
    ("image", "code"),
    [
        (_bomb(), "image_too_large"),
        (encoded(RAMP)[: len(encoded(RAMP)) // 2], "image_unreadable"),
        (encoded(RAMP, "JPEG")[:300], "image_unreadable"),
        (b"GIF89a" + bytes(50), "image_unreadable"),
        (b"", "image_unreadable"),
        (b"\x89PNG\r\n\x1a\n" + bytes(80), "image_unreadable"),
    ],
    ids=["bomb", "truncated png", "truncated jpeg", "another format", "empty", "broken png"],
)
@pytest.mark.parametrize("kind", ["obj", "ply", "glb", "3mf"])
def test_a_hostile_image_is_a_warning_with_a_code_and_nothing_is_lost(
    kind: str, image: bytes, code: str, tmp_path: Path
) -> None:
    path = WRITERS[kind](tmp_path, RAMPED.with_image(image))
    before = read_scan(path)
    report = repaired(path)
    (problem,) = report["texture"]["problems"]
    assert problem["code"] == code
    assert report["texture"]["page"] is None
    assert sum(f"({code})" in warning for warning in report["warnings"]) == 1
    after = read_scan(tmp_path / f"out.{kind}")
    m = len(before.triangles)
    assert len(after.triangles) > m
    assert texture_of(after).coordinates[:m].tobytes() == texture_of(before).coordinates.tobytes()


def test_one_broken_image_does_not_keep_the_other_from_being_carried_on(tmp_path: Path) -> None:
    textured = with_two_materials(RAMPED, 0.0, encoded(GREY))
    textured = replace(textured, images={**textured.images, "wood.png": encoded(RAMP)[: len(encoded(RAMP)) // 2]})
    path = write_obj(tmp_path, textured)
    report = repaired(path)
    assert [problem["code"] for problem in report["texture"]["problems"]] == ["image_unreadable"]
    assert report["texture"]["page"] is not None
    after = read_scan(tmp_path / "out.obj")
    new = slice(len(read_scan(path).triangles), None)
    right = after.vertices[after.triangles[new]].mean(axis=1)[:, 0] > 0
    texture = texture_of(after)
    last = len(texture.images) - 1
    assert (texture.material[new][right] == last).all()
    assert (texture.material[new][~right] != last).all()


@pytest.mark.parametrize("kind", ["obj", "ply", "gltf"])
def test_a_missing_image_is_a_warning_and_coordinates_are_spread_as_before(kind: str, tmp_path: Path) -> None:
    path = WRITERS[kind](tmp_path, RAMPED)
    (tmp_path / "wood.png").unlink()
    report = repaired(path)
    assert [problem["code"] for problem in report["texture"]["problems"]] == ["image_missing"]
    assert "'wood.png'" in report["warnings"][0]
    assert not list(tmp_path.glob("*_fill_*"))
    after = read_scan(tmp_path / f"out.{kind}")
    new = texture_of(after).coordinates[len(read_scan(path).triangles) :]
    assert ((new >= 0) & (new <= 1)).all()


def test_a_missing_material_library_is_a_warning(tmp_path: Path) -> None:
    path = write_obj(tmp_path, RAMPED)
    (tmp_path / "scan.mtl").unlink()
    report = repaired(path)
    assert [problem["code"] for problem in report["texture"]["problems"]] == ["image_missing"]
    (warning,) = report["warnings"]
    assert "'scan.mtl'" in warning
    assert "(image_missing)" in warning


@pytest.mark.parametrize("name", ["../wood.png", "/etc/passwd", "C:\\scans\\wood.png", "a\0b", "x" * 5000])
def test_images_outside_the_folder_are_never_opened(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "scan"
    folder.mkdir()
    path = write_obj(folder, RAMPED)
    (folder / "wood.png").rename(tmp_path / "wood.png")
    (folder / "scan.mtl").write_text(f"newmtl wood\nmap_Kd {name}\n")
    report = repaired(path)
    assert [problem["code"] for problem in report["texture"]["problems"]] == ["image_missing"]


def test_a_path_of_another_machine_leads_to_the_image_beside_the_mesh(tmp_path: Path) -> None:
    path = write_obj(tmp_path, RAMPED)
    (tmp_path / "scan.mtl").write_text("newmtl wood\nmap_Kd -clamp on C:\\scans\\wood.png\n")
    assert repaired(path)["texture"]["page"] is not None


def test_a_file_with_pages_can_be_repaired_again(tmp_path: Path) -> None:
    # The second repair finds the hole that the first was told to leave.
    from quadpatch.options import HoleOptions  # noqa: PLC0415

    for kind, write in WRITERS.items():
        folder = tmp_path / kind
        folder.mkdir()
        path = write(folder, RAMPED)
        holes = [row["id"] for row in repaired(path, name="all")["holes"] if row["new_triangles"]]
        assert len(holes) == 2
        repaired(path, RepairOptions(HoleOptions(ids=(holes[0],)), colours="harmonic"), "first")
        report = repaired(folder / f"first{path.suffix}", name="second")
        assert report["texture"]["page"] is not None, kind
        after = read_scan(folder / f"second{path.suffix}")
        new = slice(len(read_scan(path).triangles), None)
        assert np.abs(colours_of(after, new) - ramp_at(after, new)).max() < 8


def test_vertex_coordinates_of_ply_have_no_room_for_a_page(tmp_path: Path) -> None:
    lines = ["ply", "format ascii 1.0", "comment TextureFile wood.png", f"element vertex {len(PLATE.vertices)}"]
    lines += [f"property double {name}" for name in "xyzst"]
    lines += [f"element face {len(PLATE.triangles)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(repr, [*v, v[0] / 2 + 0.5, v[1] / 2 + 0.5])) for v in PLATE.vertices.tolist()]
    lines += [" ".join(map(str, [3, *t])) for t in PLATE.triangles.tolist()]
    path = tmp_path / "scan.ply"
    path.write_text("\n".join([*lines, ""]))
    (tmp_path / "wood.png").write_bytes(encoded(RAMP))
    (warning,) = repaired(path)["warnings"]
    assert "texture coordinates of vertices" in warning
    assert "(unusable_texture)" in warning


def test_an_ascii_ply_gets_the_same_page_as_a_binary_one(tmp_path: Path) -> None:
    pages = []
    for is_ascii in (False, True):
        folder = tmp_path / str(is_ascii)
        folder.mkdir()
        repaired(write_ply(folder, RAMPED, is_ascii))
        pages += [file.read_bytes() for file in folder.glob("*_fill_*.png")]
    assert len(pages) == 2
    assert pages[0] == pages[1]


def test_another_format_is_written_without_images_and_says_so(tmp_path: Path) -> None:
    path = write_obj(tmp_path, RAMPED)
    report = repair_file(path, tmp_path / "out.glb", "smooth", HARMONIC)
    assert ".glb is written without the texture images of the scan" in report["warnings"]
    assert report["texture"] is None


def test_a_gltf_becomes_a_binary_one_with_its_materials(tmp_path: Path) -> None:
    path = write_gltf(tmp_path, RAMPED)
    report = repair_file(path, tmp_path / "out.glb", "smooth", HARMONIC)
    assert report["texture"]["page"] is not None
    after = read_scan(tmp_path / "out.glb")
    new = slice(len(read_scan(path).triangles), None)
    assert np.abs(colours_of(after, new) - ramp_at(after, new)).max() < 8


def test_a_transform_of_texture_coordinates_is_followed(tmp_path: Path) -> None:
    path = write_gltf(tmp_path, RAMPED)
    document = json.loads(path.read_text())
    info = document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
    # A quarter turn, halved and shifted: what lies at (u, v) is read at (v / 2 + 0.25, 0.75 - u / 2).
    info["extensions"] = {"KHR_texture_transform": {"offset": [0.25, 0.75], "rotation": np.pi / 2, "scale": [0.5, 0.5]}}
    path.write_text(json.dumps(document))
    texture = texture_of(read_scan(path))
    u, v = np.moveaxis(RAMPED.coordinates, 2, 0)
    assert np.abs(texture.coordinates[..., 0] - ((1 - v) / 2 + 0.25)).max() < 1e-6
    assert np.abs(1 - texture.coordinates[..., 1] - (0.75 - u / 2)).max() < 1e-6


def test_a_material_of_a_page_keeps_no_image_that_knows_nothing_of_it(tmp_path: Path) -> None:
    path = write_gltf(tmp_path, RAMPED)
    document = json.loads(path.read_text())
    material = document["materials"][0]
    material["pbrMetallicRoughness"] |= {"metallicRoughnessTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 1]}
    material |= {"normalTexture": {"index": 0}, "emissiveTexture": {"index": 0}, "emissiveFactor": [1, 1, 1]}
    material |= {"name": "wood", "doubleSided": True}
    path.write_text(json.dumps(document))
    repaired(path)
    written = json.loads((tmp_path / "out.gltf").read_text())
    assert written["materials"][0] == material
    pbr = {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0.0, "roughnessFactor": 1.0}
    assert written["materials"][1] == {
        "name": "wood",
        "doubleSided": True,
        "pbrMetallicRoughness": {**pbr, "baseColorTexture": {"index": 1}},
    }


def test_a_library_of_a_page_names_the_page_alone(tmp_path: Path) -> None:
    repaired(write_obj(tmp_path, RAMPED))
    (library,) = tmp_path.glob("*_fill_*.mtl")
    lines = library.read_text().splitlines()
    assert lines[2:] == [f"newmtl wood_{library.stem}", "Kd 1 1 1", f"map_Kd {library.stem}.png"]


def test_a_package_names_its_page_where_3mf_wants_it(tmp_path: Path) -> None:
    repaired(write_3mf(tmp_path, RAMPED, ' transform="1 0 0 0 1 0 0 0 -1 0 0 0"'))
    with zipfile.ZipFile(tmp_path / "out.3mf") as package:
        (page,) = [name for name in package.namelist() if "_fill_" in name]
        assert page.encode() in package.read("3D/_rels/3dmodel.model.rels")
        assert b'Extension="png"' in package.read("[Content_Types].xml")
        model = package.read("3D/3dmodel.model")
    # What an object names has to stand in front of it.
    assert model.index(page.encode()) < model.index(b"<object")
    after = read_scan(tmp_path / "out.3mf")
    new = slice(len(PLATE.triangles), None)
    assert np.abs(colours_of(after, new) - ramp_at(after, new)).max() < 8


def test_a_failure_of_painting_is_a_warning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("quadpatch.textures.painting.paint_fills", fail)
    path = write_obj(tmp_path, RAMPED)
    report = repaired(path)
    assert report["warnings"] == ["the texture images of the scan are not carried on: there is not enough memory"]
    assert len(read_scan(tmp_path / "out.obj").triangles) > len(PLATE.triangles)


@pytest.mark.parametrize("kind", ["obj", "glb"])
def test_detail_is_carried_on_where_calibration_says_so(kind: str, tmp_path: Path) -> None:
    grain = np.random.default_rng(0).normal(0, 1, (128, 128))
    grain = (grain + np.roll(grain, 1, 0) + np.roll(grain, 1, 1) + np.roll(grain, 1, (0, 1))) / 2
    pixels = np.clip(128 + 40 * grain, 0, 255).astype(np.uint8)[..., np.newaxis].repeat(3, axis=2)
    path = WRITERS[kind](tmp_path, flat(PLATE, encoded(pixels)))
    spreads = []
    for options in (HARMONIC, RepairOptions()):
        report = repaired(path, options)
        after = read_scan(tmp_path / f"out.{kind}")
        spreads.append(float(colours_of(after, slice(len(PLATE.triangles), None)).std()))
    assert report["texture"]["method"] == "exemplars"
    assert report["texture"]["calibration"]["n_holes"] >= 12
    assert [stage["name"] for stage in report["stages"]][-2:] == ["colour", "write"]
    assert spreads[1] > 1.6 * spreads[0]
