"""Texture coordinates across the seams of an atlas."""

import numpy as np

from quadpatch.formats.scan import Fill, Scan
from quadpatch.formats.texture import extend_over_corners
from tests.quadpatch.formats.fills import as_scan, cap_holes
from tests.quadpatch.shapes import punched, sphere


def ball() -> tuple[Scan, Fill]:
    scan = as_scan(punched(sphere(2), (0.3, 0.2, 1.0), radius=0.5))
    return scan, cap_holes(scan)


def test_one_chart_spreads_without_leaving_its_range() -> None:
    scan, fill = ball()
    flat = scan.vertices[:, :2]
    extended = extend_over_corners(scan, fill, flat[scan.triangles])
    rim = np.unique(fill.triangles[fill.triangles < len(scan.vertices)])
    assert (extended.min(axis=(0, 1)) >= flat[rim].min(axis=0)).all()
    assert (extended.max(axis=(0, 1)) <= flat[rim].max(axis=0)).all()
    corners = fill.triangles < len(scan.vertices)
    assert (extended[corners] == flat[fill.triangles[corners]]).all()


def test_a_hole_on_a_seam_stays_in_the_chart_that_surrounds_most_of_it() -> None:
    scan, fill = ball()
    flat = scan.vertices[:, :2] / 4
    texture = flat[scan.triangles]
    # A quarter of the sphere lies elsewhere in the atlas.
    far = scan.vertices[scan.triangles].mean(axis=1)[:, 0] > 0.55
    texture[far] += 10
    extended = extend_over_corners(scan, fill, texture)
    assert np.isfinite(extended).all()
    assert extended.max() < 1


def test_a_rim_without_texture_gives_none() -> None:
    scan, fill = ball()
    assert np.isnan(extend_over_corners(scan, fill, np.full((len(scan.triangles), 3, 2), np.nan))).all()


def test_half_a_textured_rim_is_enough() -> None:
    scan, fill = ball()
    texture = np.full((len(scan.triangles), 3, 2), 0.25)
    texture[::2] = np.nan
    assert (extend_over_corners(scan, fill, texture) == 0.25).all()
