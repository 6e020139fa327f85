"""The 3D view of `web/src/viewer` in a real browser: what it shows is told by its pixels."""

import re

import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Page, expect

from tests.integration.browser import AXE, Service, Visit
from tests.integration.conftest import ply_bytes, punched_relief

Colour = NDArray[np.int64]
GREEN = (0, 255, 0)
# A relief of side 1 with four holes in a row; hole 3 is 0.13 wide.
N = 44


@pytest.fixture
def mesh(api: Service) -> str:
    return api.upload(ply_bytes(*punched_relief(N)), "seen.ply")


@pytest.fixture
def job(api: Service, mesh: str) -> str:
    return api.repair(mesh, holes={"rules": [{"ids": [1], "action": "skip"}]})


def open_mesh(visit: Visit, mesh: str) -> None:
    visit.go(f"meshes/{mesh}")
    expect(visit.page.locator("canvas[data-before][data-outlines='5']")).to_be_visible()


def open_job(visit: Visit, job: str) -> None:
    visit.go(f"jobs/{job}")
    expect(visit.page.locator("canvas[data-before][data-after][data-outlines='5']")).to_be_visible()


def fly_to(page: Page, hole: int) -> None:
    page.get_by_role("button", name=f"Fly to hole {hole}").click()
    expect(page.locator(f"canvas[data-hole='{hole}']")).to_be_visible()


def middle(picture: NDArray[np.uint8]) -> Colour:
    """The median colour of a small square in the middle."""
    height, width, _ = picture.shape
    square = picture[height // 2 - 6 : height // 2 + 6, width // 2 + 14 : width // 2 + 26]
    return np.asarray(np.median(square.reshape(-1, 3), axis=0), np.int64)


def covered(picture: NDArray[np.uint8]) -> float:
    """The share of the picture where something is drawn."""
    return float((picture != GREEN).any(axis=2).mean())


def is_like(colour: Colour, other: tuple[int, int, int]) -> bool:
    """Whether two colours have the same hue and about the same saturation, whatever the light is."""
    scaled, wanted = colour / max(colour.max(), 1), np.array(other) / max(other)
    return bool(np.abs(scaled - wanted).max() < 0.2)


def test_the_view_shows_the_mesh_with_its_holes_outlined_and_numbered(visit: Visit, mesh: str) -> None:
    open_mesh(visit, mesh)
    picture = visit.picture()
    assert 0.15 < covered(picture) < 0.85
    outlined = (picture[..., 0] > 180) & (picture[..., 1] < 120) & (picture[..., 2] < 90)
    assert outlined.sum() > 200
    expect(visit.page.locator(".hole-number:visible")).to_have_count(5)
    visit.page.get_by_label("Outline holes").uncheck()
    expect(visit.page.locator(".hole-number:visible")).to_have_count(0)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_an_open_scan_is_first_seen_from_outside(visit: Visit, api: Service, axis: int) -> None:
    vertices, triangles = punched_relief(30)
    turned = np.roll(vertices * [1.0, 1.0, -1.0], axis, axis=1)
    open_mesh(visit, api.upload(ply_bytes(turned, triangles[:, ::-1]), f"turned_{axis}.ply"))
    expect(visit.page.locator(".hole-number:visible")).to_have_count(5)
    assert 0.15 < covered(visit.picture()) < 0.85


def test_a_click_on_hole_3_flies_there_in_the_view_and_in_the_list(visit: Visit, mesh: str) -> None:
    page = visit.page
    open_mesh(visit, mesh)
    number = page.locator(".hole-number").get_by_text("3", exact=True)
    number.click()
    expect(page.locator("canvas[data-hole='3']")).to_be_visible()
    expect(page.locator("tr.selected")).to_have_attribute("data-hole", "3")
    # Its hole is in the middle and open: nothing is drawn there, but around it.
    assert tuple(middle(visit.picture())) == GREEN
    box, canvas = number.bounding_box(), page.locator("canvas").bounding_box()
    assert box is not None
    assert canvas is not None
    assert abs(box["x"] + box["width"] / 2 - canvas["x"] - canvas["width"] / 2) < 3
    assert abs(box["y"] + box["height"] / 2 - canvas["y"] - canvas["height"] / 2) < 3
    page.get_by_role("button", name="Show all").click()
    expect(page.locator("canvas[data-hole='']")).to_be_visible()
    fly_to(page, 2)
    page.get_by_role("button", name="Show all").click()
    expect(page.locator("canvas[data-hole='']")).to_be_visible()
    # Beside the number, into the hole itself.
    place = page.locator(".hole-number").get_by_text("1", exact=True).bounding_box()
    assert place is not None
    page.mouse.click(place["x"] + place["width"] / 2, place["y"] + place["height"] + 4)
    expect(page.locator("canvas[data-hole='1']")).to_be_visible()


def test_the_slider_shows_before_on_its_left_and_after_on_its_right(visit: Visit, job: str) -> None:
    page = visit.page
    open_job(visit, job)
    fly_to(page, 3)
    slider = page.get_by_role("slider", name="Before and after")
    slider.fill("1")
    assert tuple(middle(visit.picture())) == GREEN
    slider.fill("0")
    assert is_like(middle(visit.picture()), (232, 145, 45))
    # By keyboard, too: the end of the slider is all before.
    slider.focus()
    page.keyboard.press("End")
    assert tuple(middle(visit.picture())) == GREEN
    # Hole 1 was left open: it is so after the repair as well.
    slider.fill("0")
    fly_to(page, 1)
    assert tuple(middle(visit.picture())) == GREEN


def test_tints_show_figures_of_invented_surface_with_their_range(visit: Visit, job: str) -> None:
    page = visit.page
    open_job(visit, job)
    page.get_by_role("slider", name="Before and after").fill("0")
    fly_to(page, 3)
    colours = {}
    for tint in ("measured and invented", "confidence", "expected error", "distance to the plain fill"):
        page.get_by_label("Colours show").select_option(tint)
        if tint != "measured and invented":
            expect(page.locator(".legend")).to_contain_text(re.compile(rf"{tint}: [\d.,]+ ?(%|units)"))
        colours[tint] = middle(visit.picture())
    assert is_like(colours["measured and invented"], (232, 145, 45))
    for tint in ("confidence", "expected error", "distance to the plain fill"):
        assert not is_like(colours[tint], (232, 145, 45)), tint


def test_the_distance_to_a_dropped_reference_is_shown(visit: Visit, job: str) -> None:
    page = visit.page
    vertices, triangles = punched_relief(30, n_holes=0)
    open_job(visit, job)
    area = page.locator(".dropzone")
    visit.drop(area, "raised.ply", ply_bytes(vertices + np.array([0.0, 0.0, 0.25]), triangles))
    legend = page.locator(".legend")
    expect(legend).to_contain_text("distance to the reference")
    low, high = re.findall(r"([\d.]+) units", legend.inner_text())
    # The reference lies 0.25 above; the surfaces wave by 0.02.
    assert 0.2 < float(low) <= float(high) < 0.26


def test_colours_of_vertices_are_shown_first(visit: Visit, api: Service) -> None:
    vertices, triangles = punched_relief(30)
    rows = [f"{x:.6f} {y:.6f} {z:.6f} 220 20 30" for x, y, z in vertices]
    faces = ["3 {} {} {}".format(*corners) for corners in triangles]
    header = (
        f"ply\nformat ascii 1.0\nelement vertex {len(rows)}\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    open_mesh(visit, api.upload("\n".join([header.rstrip(), *rows, *faces, ""]).encode(), "red.ply"))
    expect(visit.page.get_by_label("Colours show")).to_have_value("colours")
    picture = visit.picture()
    drawn = picture[(picture != GREEN).any(axis=2)].astype(np.int64)
    assert is_like(np.median(drawn, axis=0).astype(np.int64), (220, 20, 30))


def test_a_section_plane_takes_surface_away(visit: Visit, mesh: str) -> None:
    page = visit.page
    open_mesh(visit, mesh)
    page.get_by_label("Outline holes").uncheck()
    whole = covered(visit.picture())
    page.get_by_label("Section across").select_option("X")
    half = covered(visit.picture())
    assert 0.35 * whole < half < 0.65 * whole
    page.get_by_label("Place of the section").fill("0.25")
    assert covered(visit.picture()) < 0.7 * half


def test_a_distance_is_measured_by_pointer_and_by_keyboard(visit: Visit, mesh: str) -> None:
    page = visit.page
    open_mesh(visit, mesh)
    fly_to(page, 3)
    canvas = page.locator("canvas")
    box = canvas.bounding_box()
    assert box is not None
    page.get_by_role("button", name="Measure", exact=True).click()
    centre, reach = box["x"] + box["width"] / 2, 0.35 * box["height"]
    for place in (centre - reach, centre + reach):
        page.mouse.click(place, box["y"] + box["height"] / 2)
    readout = page.locator(".readout")
    expect(readout).to_have_text(re.compile(r"^Distance: 0\.\d+ units$"))
    # A hole is seen from where the picture is 2 / cos(35° / 2) of its diameters high.
    hole = float(page.locator("tr[data-hole='3'] td").first.inner_text())
    expected = 2 * 0.35 * 2 / np.cos(np.radians(17.5)) * hole
    assert float(readout.inner_text().split()[1]) == pytest.approx(expected, rel=0.05)
    # By keyboard: the point under the cross, before and after a turn.
    page.get_by_role("button", name="Show all").click()
    expect(page.locator("canvas[data-hole='']")).to_be_visible()
    canvas.focus()
    page.keyboard.press("m")
    page.keyboard.press("m")
    expect(readout).to_contain_text("Choose two points")
    page.keyboard.press("Enter")
    page.keyboard.press("Enter")
    expect(readout).to_have_text(re.compile(r"^Distance: 0 units$"))


def test_keys_turn_the_view_and_go_from_hole_to_hole(visit: Visit, mesh: str) -> None:
    page = visit.page
    open_mesh(visit, mesh)
    page.locator("canvas").focus()
    before = visit.picture()
    page.keyboard.press("ArrowRight")
    turned = visit.picture()
    assert (before != turned).any()
    page.keyboard.press("-")
    assert covered(visit.picture()) < covered(turned)
    for hole in ("0", "1", "2"):
        page.keyboard.press("n")
        expect(page.locator(f"canvas[data-hole='{hole}']")).to_be_visible()
    page.keyboard.press("p")
    expect(page.locator("canvas[data-hole='1']")).to_be_visible()
    page.keyboard.press("x")
    expect(page.get_by_label("What to do with hole 1")).to_have_value("flat")


def test_the_atoms_of_a_dictionary_are_drawn(visit: Visit) -> None:
    visit.go("models")
    picture = visit.page.get_by_role("img", name="The atoms of general-dictionary")
    expect(picture).to_be_visible()
    assert picture.evaluate("(picture) => picture.decode().then(() => picture.naturalWidth)") > 100


def test_axe_finds_no_violation_while_the_view_is_used(visit: Visit, job: str) -> None:
    if not AXE.is_file():
        pytest.skip("the Node.js packages of web/ are not installed; `make test` does")
    page = visit.page
    open_job(visit, job)
    fly_to(page, 3)
    page.get_by_label("Colours show").select_option("expected error")
    page.get_by_label("Section across").select_option("Z")
    page.get_by_role("button", name="Measure", exact=True).click()
    assert visit.violations() == []
