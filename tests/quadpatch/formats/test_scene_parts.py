import numpy as np

from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.scene_parts import Part, is_invertible, place, split_by_part
from quadpatch.types import FloatArray

CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
MIRRORED: FloatArray = np.diag([-2.0, 2, 2, 1])
FLAT: FloatArray = np.diag([1.0, 1, 0, 1])


def shifted(by: float) -> FloatArray:
    matrix: FloatArray = np.eye(4)
    matrix[0, 3] = by
    return matrix


def scene(*matrices: FloatArray) -> tuple[Scan, Fill, list[Part]]:
    """One half of a square for each part, and a fill of the other halves, each with one new vertex."""
    parts = [Part(4 * i, CORNERS, matrix) for i, matrix in enumerate(matrices)]
    vertices = np.concatenate([place(CORNERS, part.matrix) for part in parts])
    n = len(parts)
    scan = Scan(vertices, np.array([[4 * i, 4 * i + 1, 4 * i + 2] for i in range(n)]), "memory")
    new = np.concatenate([place(np.array([[0.4, 0.6, 0.0]]), part.matrix) for part in parts])
    triangles = np.array([[4 * i, 4 * i + 2, 4 * n + i] for i in range(n)])
    sure, holes = np.ones(n), np.arange(n)
    return scan, Fill(new, triangles, holes, sure, holes, sure), parts


def test_the_identity_leaves_bits_alone_and_a_transform_moves() -> None:
    assert place(CORNERS, np.eye(4)) is CORNERS
    assert place(CORNERS, shifted(3.0)).tolist() == [[3, 0, 0], [4, 0, 0], [4, 1, 0], [3, 1, 0]]


def test_a_transform_is_invertible_unless_it_flattens() -> None:
    assert is_invertible(MIRRORED)
    assert not is_invertible(FLAT)
    assert Part(0, CORNERS, MIRRORED).is_mirrored
    assert not Part(0, CORNERS, shifted(1.0)).is_mirrored


def test_each_part_gets_its_holes_in_its_own_coordinates_turned_as_its_own_triangles() -> None:
    plain, mirrored = split_by_part(*scene(shifted(5.0), MIRRORED))
    assert (plain.part, mirrored.part) == (0, 1)
    assert plain.vertex.tolist() == [0, 2, 8]
    assert mirrored.vertex.tolist() == [4, 6, 9]
    for found in (plain, mirrored):
        # Measured vertices are the part's own numbers, bit for bit.
        assert found.positions[:2].tobytes() == CORNERS[[0, 2]].tobytes()
        np.testing.assert_allclose(found.positions[2], [0.4, 0.6, 0.0], atol=1e-12)
    assert plain.triangles.tolist() == [[0, 1, 2]]
    assert mirrored.triangles.tolist() == [[0, 2, 1]]
    assert (plain.rows.tolist(), mirrored.rows.tolist()) == ([0], [1])


def test_the_holes_of_a_flattened_part_go_to_another_one() -> None:
    (other,) = split_by_part(*scene(FLAT, shifted(5.0)))
    assert other.part == 1
    assert other.rows.tolist() == [0, 1]
