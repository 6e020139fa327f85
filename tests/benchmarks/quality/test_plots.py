import numpy as np
from matplotlib.patches import Rectangle

from benchmarks.quality.plots import atoms_plot, calibration_plot, curve_plot, labelled_plot, ratio_plot
from quadpatch.sparse.dictionary import Dictionary


def test_each_method_has_a_bar_for_each_mesh_and_none_where_it_was_not_measured() -> None:
    (axes,) = ratio_plot("ratios", ["a", "b"], {"one": [0.5, 2.0], "two": [None, 1.0]}).axes
    heights = [bar.get_height() for bar in axes.patches if isinstance(bar, Rectangle)]
    np.testing.assert_array_equal(heights, [0.5, 2.0, np.nan, 1.0])
    assert [label.get_text() for label in axes.get_xticklabels()] == ["a", "b"]


def test_holes_without_an_expectation_are_counted_and_not_drawn() -> None:
    holes = [{"expected_error": e, "true_error": t} for e, t in ((1.0, 2.0), (None, 3.0), (4.0, 0.0), (5.0, 4.0))]
    (axes,) = calibration_plot({"smooth": holes}).axes
    points, diagonal = axes.lines
    assert np.asarray(points.get_xydata()).tolist() == [[1.0, 2.0], [5.0, 4.0]]
    assert np.asarray(diagonal.get_xydata()).tolist() == [[1.0, 1.0], [5.0, 5.0]]
    assert axes.get_title() == "smooth, 4 holes"


def test_a_curve_has_a_gap_where_a_value_is_missing() -> None:
    (axes,) = curve_plot("curve", ("atoms", "error"), [1, 2, 3], {"a": [0.1, None, 0.3]}).axes
    np.testing.assert_array_equal(np.asarray(axes.lines[0].get_ydata(), np.float64), [0.1, np.nan, 0.3])
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("atoms", "error")


def test_points_bear_their_names_and_values_to_compare_with_are_lines() -> None:
    (axes,) = labelled_plot("sizes", ("x", "y"), {"small": (1e3, 2.0)}, {"fair": 0.5}).axes
    assert [text.get_text() for text in axes.texts] == ["small"]
    point, line = axes.lines
    assert np.asarray(point.get_xydata()).tolist() == [[1e3, 2.0]]
    assert list(np.asarray(line.get_ydata())) == [0.5, 0.5]


def test_atoms_are_drawn_smooth_ones_first_each_by_its_own_scale() -> None:
    flat, ramp = np.ones((4, 4)), np.tile(np.arange(4.0), (4, 1))
    checks = np.indices((4, 4)).sum(axis=0) % 2 - 0.5
    atoms = np.stack([(one / np.linalg.norm(one)).ravel() for one in (checks, ramp, flat)], axis=1)
    figure = atoms_plot("atoms", Dictionary(atoms, 4, 2))
    images = [axes.images[0] for axes in figure.axes if axes.images]
    drawn = [np.asarray(image.get_array(), np.float64) for image in images]
    for shown, one in zip(drawn, (flat, ramp, checks), strict=True):
        np.testing.assert_allclose(shown, one / np.linalg.norm(one))
    assert [image.get_clim() for image in images] == [(-abs(one).max(), abs(one).max()) for one in drawn]
