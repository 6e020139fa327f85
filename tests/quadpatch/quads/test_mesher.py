from pathlib import Path

import numpy as np
import pytest

from quadpatch.errors import NoQuadsError
from quadpatch.quads.frames import quad_frames, quad_normals
from quadpatch.quads.mesher import quadrangulate
from quadpatch.types import FloatArray, QuadMesh, TriangleMesh


def plane(n: int, side: float = 1.0) -> TriangleMesh:
    x, y = np.meshgrid(np.linspace(0, side, n), np.linspace(0, side, n))
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return TriangleMesh(np.stack([x.ravel(), y.ravel(), np.zeros(n * n)], axis=1), triangles)


def sphere(n: int = 60) -> TriangleMesh:
    """Build a unit sphere with n rings, poles closed."""
    flat = plane(n)
    polar, around = np.pi * flat.vertices[:, 0], 2 * np.pi * flat.vertices[:, 1]
    points = np.stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], axis=1)
    vertices, weld = np.unique(np.round(points, 12), axis=0, return_inverse=True)
    triangles = weld.ravel()[flat.triangles]
    corners = np.sort(triangles, axis=1)
    return TriangleMesh(vertices, triangles[(np.diff(corners, axis=1) > 0).all(axis=1)])


def joined(one: TriangleMesh, other: TriangleMesh) -> TriangleMesh:
    return TriangleMesh(
        np.concatenate([one.vertices, other.vertices]),
        np.concatenate([one.triangles, other.triangles + len(one.vertices)]),
    )


def side_lengths(quad_mesh: QuadMesh) -> FloatArray:
    corners = quad_mesh.vertices[quad_mesh.quads]
    return np.asarray(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2))


def test_quads_have_about_the_wanted_side_and_cover_the_sphere() -> None:
    quad_mesh = quadrangulate(sphere(), 0.25)
    assert float(side_lengths(quad_mesh).mean()) == pytest.approx(0.25, rel=0.15)
    area = np.linalg.norm(quad_normals(quad_mesh.vertices, quad_mesh.quads), axis=1).sum() / 2
    assert area == pytest.approx(4 * np.pi, rel=0.05)
    np.testing.assert_allclose(np.linalg.norm(quad_mesh.vertices, axis=1), 1, atol=0.02)


@pytest.mark.parametrize("inside_out", [False, True])
def test_quads_face_the_way_the_surface_does(inside_out: bool) -> None:
    ball = sphere()
    turned = TriangleMesh(ball.vertices, ball.triangles[:, ::-1]) if inside_out else ball
    quad_mesh = quadrangulate(turned, 0.25)
    outward = np.einsum(
        "ij,ij->i", quad_normals(quad_mesh.vertices, quad_mesh.quads), quad_mesh.vertices[quad_mesh.quads].mean(axis=1)
    )
    assert (outward < 0).all() if inside_out else (outward > 0).all()


def test_the_same_surface_gives_the_same_quads() -> None:
    one, other = quadrangulate(sphere(), 0.2), quadrangulate(sphere(), 0.2)
    np.testing.assert_array_equal(one.vertices, other.vertices)
    np.testing.assert_array_equal(one.quads, other.quads)


def crossing_waves() -> TriangleMesh:
    """Build three wavy sheets that share vertices and edges where they cross: far from a manifold."""
    sheet = plane(90)
    x, y = sheet.vertices[:, 0], sheet.vertices[:, 1]
    sheets = []
    for k in range(3):
        heights = 0.5 + 0.2 * np.sin(9 * x + 2 * k) * np.cos(7 * y + k)
        sheets.append(TriangleMesh(np.stack([x, y, heights], axis=1), sheet.triangles))
    crossed = joined(joined(sheets[0], sheets[1]), sheets[2])
    cells = np.round(crossed.vertices * 60) / 60
    vertices, weld = np.unique(cells, axis=0, return_inverse=True)
    return TriangleMesh(vertices, weld.ravel()[crossed.triangles])


def test_even_a_surface_that_is_no_manifold_gives_the_same_quads_every_time() -> None:
    surface = crossing_waves()
    first = quadrangulate(surface, 0.08)
    for _ in range(3):
        again = quadrangulate(surface, 0.08)
        np.testing.assert_array_equal(again.vertices, first.vertices)
        np.testing.assert_array_equal(again.quads, first.quads)


def test_quads_stay_on_the_surface_at_coordinates_of_a_million() -> None:
    flat = plane(40, side=0.5)
    shift = np.array([1e6, -2e6, 3e6])
    quad_mesh = quadrangulate(TriangleMesh(flat.vertices + shift, flat.triangles), 0.05)
    low, high = quad_mesh.vertices.min(axis=0) - shift, quad_mesh.vertices.max(axis=0) - shift
    np.testing.assert_allclose(low, 0, atol=0.05)
    np.testing.assert_allclose(high, [0.5, 0.5, 0], atol=0.05)
    np.testing.assert_allclose(quad_mesh.vertices[:, 2], 3e6, atol=1e-6)


def test_both_sides_of_a_thin_wall_get_quads() -> None:
    front = plane(40)
    back = TriangleMesh(front.vertices - [0, 0, 0.01], front.triangles[:, ::-1])
    z = quad_frames(quadrangulate(joined(front, back), 0.1))[:, 2, 2]
    assert np.sum(z > 0.99) == pytest.approx(100, rel=0.3)
    assert np.sum(z < -0.99) == pytest.approx(100, rel=0.3)


def broken_surfaces() -> dict[str, TriangleMesh]:
    flat = plane(40)
    n = len(flat.vertices)
    rng = np.random.default_rng(0)
    is_right = flat.vertices[flat.triangles][:, :, 0].mean(axis=1) > 0.5
    wall = TriangleMesh(flat.vertices[:, [0, 2, 1]] + [0, 0.5, 0], flat.triangles)
    return {
        "half of it turned inside out": TriangleMesh(
            flat.vertices, np.where(is_right[:, None], flat.triangles[:, ::-1], flat.triangles)
        ),
        "triangles without area": TriangleMesh(
            flat.vertices, np.concatenate([flat.triangles, flat.triangles[:, [0, 0, 1]]])
        ),
        "unused vertices": TriangleMesh(np.concatenate([flat.vertices, [[1e9, 0, 0]]]), flat.triangles),
        "a wall through it": joined(flat, wall),
        "every triangle twice": TriangleMesh(flat.vertices, np.concatenate([flat.triangles, flat.triangles])),
        "not welded": TriangleMesh(
            flat.vertices[flat.triangles].reshape(-1, 3), np.arange(flat.triangles.size).reshape(-1, 3)
        ),
        "a tenth of it missing": TriangleMesh(flat.vertices, flat.triangles[rng.random(len(flat.triangles)) > 0.1]),
        "touching itself at one vertex": TriangleMesh(
            np.concatenate([flat.vertices, -flat.vertices[1:]]),
            np.concatenate([flat.triangles, np.where(flat.triangles == 0, 0, flat.triangles + n - 1)]),
        ),
    }


@pytest.mark.parametrize("name", broken_surfaces())
def test_broken_surfaces_still_give_sound_quads(name: str) -> None:
    quad_mesh = quadrangulate(broken_surfaces()[name], 0.1)
    assert len(quad_mesh.quads) > 50
    corners = np.sort(quad_mesh.quads, axis=1)
    assert (corners[:, 1:] != corners[:, :-1]).all()
    assert np.isfinite(quad_mesh.vertices).all()
    assert (np.linalg.norm(quad_normals(quad_mesh.vertices, quad_mesh.quads), axis=1) > 0).all()
    assert len(np.unique(quad_mesh.quads)) == len(quad_mesh.vertices)


def surfaces_without_quads() -> dict[str, TriangleMesh]:
    flat = plane(10)
    return {
        "no triangle": TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)),
        "a point": TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]])),
        "a line": TriangleMesh(flat.vertices * [1, 0, 0], flat.triangles),
        "smaller than a quad": TriangleMesh(flat.vertices * 0.5, flat.triangles),
        "one triangle": TriangleMesh(10 * np.eye(3), np.array([[0, 1, 2]])),
    }


@pytest.mark.parametrize("name", surfaces_without_quads())
def test_surfaces_too_small_for_a_quad_are_named_so(name: str) -> None:
    with pytest.raises(NoQuadsError):
        quadrangulate(surfaces_without_quads()[name], 0.9)


def test_nothing_is_written_and_standard_output_works_again(capfd: pytest.CaptureFixture[str]) -> None:
    quadrangulate(sphere(30), 0.3)
    print("still here")  # noqa: T201 - the point is that standard output works again
    assert capfd.readouterr().out == "still here\n"


def test_no_file_descriptor_is_left_open() -> None:
    descriptors = Path("/proc/self/fd")
    before = len(list(descriptors.iterdir()))
    for _ in range(3):
        quadrangulate(sphere(20), 0.5)
    assert len(list(descriptors.iterdir())) == before
