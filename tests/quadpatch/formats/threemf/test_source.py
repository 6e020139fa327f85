"""3MF in, 3MF out: all text stays, and holes are closed in their objects."""

import io
import zipfile

import numpy as np
import pytest
import trimesh

from quadpatch.formats.limits import ReadLimits
from quadpatch.formats.scan import Scan
from quadpatch.formats.threemf.reader import read_threemf
from tests.quadpatch.formats.fills import appended, as_scan, cap_holes, n_open_edges
from tests.quadpatch.formats.threemf.packages import CORE, mesh_text, model, package
from tests.quadpatch.shapes import punched, sphere


def read(data: bytes) -> Scan:
    return read_threemf(data, ReadLimits())


def append(scan: Scan) -> bytes:
    return appended(scan, cap_holes(scan))


def root(data: bytes) -> str:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return archive.read("3D/3dmodel.model").decode()


def ball() -> Scan:
    return as_scan(punched(sphere(2), (0, 0, 1), radius=0.5))


TRANSFORM = ' transform="0 1.5 0 -1.5 0 0 0 0 1.5 10.1 20 30"'


@pytest.mark.parametrize("transform", ["", TRANSFORM, ' transform="-1 0 0 0 1 0 0 0 1 0 0 0"'])
def test_an_object_built_once_is_closed_in_itself(transform: str) -> None:
    text = model(f'<object id="1">{mesh_text(ball())}</object>', f'<item objectid="1"{transform}/>')
    scan = read(package(text))
    data = append(scan)
    again = read(data)
    n, m = len(scan.vertices), len(scan.triangles)
    assert again.vertices[:n].tobytes() == scan.vertices.tobytes()
    assert again.triangles[:m].tolist() == scan.triangles.tolist()
    assert again.triangles[m:].tolist() == cap_holes(scan).triangles.tolist()
    assert np.abs(again.vertices[n:] - cap_holes(scan).vertices).max() < 1e-12
    # Nothing left the text: what came in is what comes out without the new elements.
    assert root(data).count("<object") == 1
    head, _, tail = text.partition("</vertices>")
    assert root(data).startswith(head)
    assert root(data).endswith(tail.partition("</triangles>")[2])
    assert 'q:hole="0" q:confidence="0.25"' in root(data)


def test_another_reader_sees_a_solid() -> None:
    data = append(read(package(model(f'<object id="1">{mesh_text(ball())}</object>', '<item objectid="1"/>'))))
    loaded = trimesh.load(io.BytesIO(data), file_type="3mf", process=False)
    (geometry,) = loaded.geometry.values()
    assert geometry.is_watertight


def test_an_object_built_twice_is_filled_beside_it() -> None:
    text = model(f'<object id="1">{mesh_text(ball())}</object>', f'<item objectid="1"/><item objectid="1"{TRANSFORM}/>')
    scan = read(package(text))
    data = append(scan)
    again = read(data)
    assert n_open_edges(scan) > 0
    assert n_open_edges(again) == 0
    assert root(data).count('name="quadpatch_filled" type="surface"') == 2
    assert again.vertices[: len(scan.vertices)].tobytes() == scan.vertices.tobytes()


def test_prefixed_elements_get_prefixed_company() -> None:
    mesh = mesh_text(ball(), prefix="c:")
    text = f'<c:model unit="meter" xmlns:c="{CORE}"><c:resources><c:object id="1">{mesh}</c:object></c:resources>'
    scan = read(package(text + '<c:build><c:item objectid="1"/></c:build></c:model>'))
    assert n_open_edges(read(append(scan))) == 0


def test_new_triangles_have_the_material_of_their_neighbours_and_other_entries_stay() -> None:
    group = '<m:colorgroup id="5"><m:color color="#FF0000"/></m:colorgroup>'
    mesh = mesh_text(ball(), material=' pid="5" p1="0"')
    scan = read(package(model(f'{group}<object id="1">{mesh}</object>', '<item objectid="1"/>')))
    data = append(scan)
    assert root(data).count('pid="5" p1="0"') == len(read(data).triangles)
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.read("Metadata/thumbnail.png") == b"\x89PNG not looked at"
