"""The page of `web/` in a real browser against a running local stack: everything but the 3D view."""

import json
import re
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Request, Route, expect

from tests.integration.browser import AXE, Service, Visit, visiting
from tests.integration.conftest import RunningStack, ply_bytes, punched_relief
from tests.waiting import wait_until


def relief(n: int = 40) -> bytes:
    return ply_bytes(*punched_relief(n))


def test_a_scan_is_dropped_repaired_and_its_result_saved(visit: Visit, api: Service, tmp_path: Path) -> None:
    page = visit.page
    visit.go("scans")
    visit.drop(page.locator(".dropzone"), "dropped.ply", relief(41))
    expect(page).to_have_url(re.compile("#/meshes/"))
    expect(page.get_by_role("heading", level=1)).to_have_text("dropped.ply")
    expect(page.locator("nav [aria-current]")).to_have_text("Scans")
    expect(
        page.get_by_role("status").filter(has_text="4 of 4 holes would be filled. Stays open besides: outer border.")
    ).to_be_visible()

    page.get_by_label("What to do with hole 2").select_option("leave open")
    page.get_by_label("What to do with hole 3").select_option("flat")
    expect(page.locator("tr[data-hole='2']")).to_contain_text("stays open: as chosen")
    expect(page.locator("tr[data-hole='3']")).to_contain_text("would be filled flat")
    page.get_by_role("radio", name="Fast").check()
    page.get_by_role("button", name="Start the repair").click()
    expect(page).to_have_url(re.compile("#/jobs/"))
    job = page.url.rpartition("/")[2]
    rules = api.get(f"/v1/jobs/{job}")["spec"]["holes"]["rules"]
    assert [(rule["action"], rule["ids"]) for rule in rules] == [("skip", [2]), ("flat", [3])]

    expect(page.get_by_text(re.compile("^done"))).to_be_visible()
    with page.expect_download() as saving:
        page.get_by_role("button", name="Download the result").click()
    assert saving.value.suggested_filename == "dropped-repaired.ply"
    saving.value.save_as(tmp_path / "saved.ply")
    assert (tmp_path / "saved.ply").read_bytes() == api.bytes_of(f"/v1/jobs/{job}/result")
    report = api.get(f"/v1/jobs/{job}/report")
    verdicts = {hole["id"]: (hole["verdict"], hole["code"]) for hole in report["holes"]}
    assert verdicts[2] == ("skipped", "rule")
    assert verdicts[3] == ("filled_smooth", "flat")
    expect(page.locator("tr[data-hole='2']")).to_contain_text("left open: as chosen")
    expect(page.locator("tr[data-hole='3']")).to_contain_text("filled smoothly: closed flat")


def test_stages_percent_and_place_in_the_queue_are_told(chromium: Browser, local_stack: RunningStack) -> None:
    """The service's answers are held back here, so that every state stands still while it is looked at."""
    job = {
        "id": "job_01", "state": "queued", "percent": 0.0, "queue_position": 3, "eta_s": 90.0, "revision": 1,
        "mesh_id": "0" * 64, "mesh_name": "part.ply", "spec": {"mesh_id": "0" * 64}, "links": {},
    }  # fmt: skip
    events = [
        {"sequence": 2, "type": "progress", "at": "", "attempt": 1, "data": {"stage": "inpaint", "percent": 41.7}},
    ]
    with visiting(chromium, local_stack.url) as visit:
        page = visit.page
        page.route("**/v1/jobs/job_01", lambda route: route.fulfill(json=job))
        page.route("**/v1/jobs/job_01/events", lambda route: route.fulfill(status=204))
        visit.go("jobs/job_01")
        status = page.get_by_role("status")
        expect(status).to_have_text("Place 3 in the queue · Time left: 2 min")
        page.unroute("**/v1/jobs/job_01/events")
        job |= {"state": "running", "queue_position": None, "eta_s": None}
        body = "".join(f"id: {one['sequence']}\ndata: {json.dumps(one)}\n\n" for one in events)
        page.route(
            "**/v1/jobs/job_01/events",
            lambda route: route.fulfill(body=body, headers={"Content-Type": "text/event-stream"}),
        )
        page.reload()
        expect(status).to_have_text("42% · adding detail")
        assert page.get_by_role("progressbar").get_attribute("value") == "41.7"


def test_an_upload_that_breaks_goes_on_where_it_was(visit: Visit, api: Service) -> None:
    page, content = visit.page, relief(120)
    sent: list[str] = []

    def cut_once(route: Route, request: Request) -> None:
        sent.append(request.method)
        if sent.count("PATCH") == 1 and request.method == "PATCH":
            route.abort()
        else:
            route.continue_()

    page.route("**/v1/uploads/*", cut_once)
    visit.go("scans")
    visit.drop(page.locator(".dropzone"), "broken.ply", content)
    expect(page.get_by_role("heading", level=1)).to_have_text("broken.ply")
    assert sent == ["PATCH", "HEAD", "PATCH"]
    assert api.bytes_of(f"/v1/meshes/{page.url.rpartition('/')[2]}/content") == content


def test_an_upload_goes_on_after_the_page_was_closed(visit: Visit, tmp_path: Path) -> None:
    page = visit.page
    (tmp_path / "closed.ply").write_bytes(relief(100))
    chooser = page.locator("input[type=file]")
    page.route("**/v1/uploads/*", lambda route: route.abort())
    visit.go("scans")
    with page.expect_request_finished(lambda request: request.url.endswith("/v1/uploads")):
        chooser.set_input_files(tmp_path / "closed.ply")
    expect(page.get_by_role("progressbar", name="Upload of closed.ply")).to_be_visible()
    page.goto("about:blank")
    page.unroute("**/v1/uploads/*")
    visit.go("scans")
    chooser.set_input_files(tmp_path / "closed.ply")
    expect(page.get_by_role("heading", level=1)).to_have_text("closed.ply")
    # One upload was begun, and the second time it was found again.
    assert sum(url.endswith("/v1/uploads") for url in visit.asked) == 1


def test_choices_of_a_job_are_taken_up_and_what_is_done_can_be_deleted(visit: Visit, api: Service) -> None:
    page = visit.page
    mesh = api.upload(relief(23), "again.ply")
    job = api.repair(mesh, label="first", holes={"rules": [{"ids": [3], "action": "skip"}]})
    page.on("dialog", lambda dialog: dialog.accept())
    visit.go(f"jobs/{job}")
    page.get_by_role("link", name="choose anew").click()
    expect(page.get_by_label("What to do with hole 3")).to_have_value("skip")
    expect(page.get_by_role("radio", name="Fast")).to_be_checked()
    page.get_by_role("button", name="Delete the scan").click()
    expect(page.get_by_role("alert")).to_contain_text("Jobs name this scan: delete those first.")
    visit.go(f"jobs/{job}")
    page.get_by_role("button", name="Delete the job").click()
    expect(page).to_have_url(re.compile("#/jobs$"))
    visit.go(f"meshes/{mesh}")
    page.get_by_role("button", name="Delete the scan").click()
    expect(page).to_have_url(re.compile("#/scans$"))
    assert api.http.get(f"/v1/meshes/{mesh}").status_code == 404


def test_errors_are_told_in_words(visit: Visit) -> None:
    page = visit.page
    visit.go("scans")
    visit.drop(page.locator(".dropzone"), "letter.ply", b"Dear Sir or Madam, this is no mesh.")
    alert = page.get_by_role("alert")
    expect(alert).to_contain_text("it can't be read as a mesh")
    expect(page.get_by_role("button", name="Start the repair")).to_have_count(0)
    visit.go("jobs/job_01m00000000000000000000000")
    expect(alert).to_contain_text("There is no such job, or no longer.")


@pytest.mark.parametrize(
    ("address", "sentence"),
    [
        ("nonsense", "There is no such page."),
        ("%", "There is no such page."),
        ("jobs/%E0%A4%A", "There is no such page."),
        ("scans/nonsense", "There is no such page."),
        ("jobs/job_nope", "There is no such job, or no longer."),
        ("batches/bat_nope", "There is no such batch, or no longer."),
        ("meshes/nope", "There is no such scan, or no longer."),
    ],
)
def test_an_address_of_nothing_is_told(visit: Visit, address: str, sentence: str) -> None:
    visit.go(address)
    expect(visit.page.get_by_role("alert")).to_have_text(sentence)


def test_lists_are_filtered_and_the_address_keeps_the_filter(visit: Visit, api: Service) -> None:
    mesh = api.upload(relief(24), "filtered.ply")
    job = api.repair(mesh, label="hall 7")
    page = visit.page
    visit.go("jobs")
    page.get_by_label("Label", exact=True).fill("hall 7")
    page.get_by_label("State", exact=True).select_option("done")
    rows = page.locator("tbody tr")
    expect(rows).to_have_count(1)
    expect(rows).to_contain_text("filtered.ply")
    page.reload()
    expect(page.get_by_label("Label", exact=True)).to_have_value("hall 7")
    page.get_by_role("link", name="filtered.ply").click()
    expect(page).to_have_url(re.compile(job))
    visit.go("jobs")
    page.get_by_label("State", exact=True).select_option("failed")
    page.get_by_label("Label", exact=True).fill("hall 7")
    expect(page.get_by_text("There is nothing here yet.")).to_be_visible()


def test_batches_rules_and_models_are_shown_and_made(visit: Visit, api: Service) -> None:
    api.upload(relief(26), "hall8-a.ply")
    page = visit.page
    visit.go("rules")
    page.get_by_label("Name", exact=True).fill("housings")
    page.get_by_label("Widest hole that is filled").fill("0.125")
    page.get_by_label("Largest expected error").fill("0.5")
    page.get_by_role("button", name="Save").click()
    expect(page.get_by_role("heading", name="housings@1")).to_be_visible()
    expect(page.get_by_text("Holes wider than 0.125 (units of the file) stay open.")).to_be_visible()
    api.http.put("/v1/rules/tight", json={"acceptance": {"max_error_share": 0.0042, "min_confidence": 0.995}})
    page.reload()
    expect(page.get_by_text("The expected error of each hole is at most 0.42% of its diameter.")).to_be_visible()
    expect(page.get_by_text("The confidence of each hole is at least 99.5%.")).to_be_visible()
    visit.go("batches")
    page.get_by_label("File name", exact=True).fill("hall8-*")
    page.get_by_role("radio", name="Fast").check()
    page.get_by_role("button", name="Start the batch").click()
    expect(page).to_have_url(re.compile("#/batches/bat_"))
    expect(page.get_by_text("ended", exact=True)).to_be_visible()
    # The list of its jobs goes along.
    expect(page.locator("tbody tr")).to_contain_text("done")
    with page.expect_download() as saving:
        page.get_by_role("button", name="Table of its jobs").click()
    assert b"hall8-a.ply" in Path(saving.value.path()).read_bytes()
    visit.go("models")
    expect(page.get_by_role("heading", name="general-dictionary@1")).to_be_visible()
    visit.go("about")
    expect(page.get_by_text("Largest file")).to_be_visible()


def test_the_first_key_may_administer_keys(
    chromium: Browser, run_stack: Callable[..., AbstractContextManager[RunningStack]]
) -> None:
    with run_stack() as stack, visiting(chromium, stack.url) as visit:
        page = visit.page
        visit.go("keys")
        expect(page.get_by_text("The first one must be allowed to administer keys")).to_be_visible()
        expect(page.get_by_label("administer keys")).to_be_checked()
        page.get_by_label("Name", exact=True).fill("office")
        page.get_by_role("button", name="Make key").click()
        secret = page.locator(".note code").inner_text()
        expect(page.locator(".note")).to_contain_text("From now on every request needs a key")
        wait_until(lambda: page.request.get(f"{stack.url}/v1/limits").status == 401)
        # This page goes on with the new key, until it signs out.
        page.reload()
        expect(page.get_by_role("row").filter(has_text="office")).to_be_visible()
        unanswered: list[Route] = []

        def hold(route: Route) -> None:
            unanswered.append(route)

        page.route("**/v1/limits", hold)
        page.get_by_role("button", name="Sign out").click()
        # However long the service takes to answer, the keys are gone.
        expect(page.get_by_role("row")).to_have_count(0)
        for request in unanswered:
            request.continue_()
        page.unroute("**/v1/limits")
        page.get_by_label("Key", exact=True).fill(secret)
        page.get_by_role("button", name="Sign in").click()
        visit.go("keys")
        expect(page.get_by_role("row").filter(has_text="office")).to_be_visible()
        expect(page.get_by_label("administer keys")).not_to_be_checked()
        expect(page.get_by_text("The first one must be allowed")).to_have_count(0)


def test_a_repair_says_what_came_out_and_marks_holes_that_miss_the_limits(visit: Visit, api: Service) -> None:
    mesh = api.upload(relief(31), "limits.ply")
    job = api.repair(mesh, acceptance={"max_expected_error": 1e-12, "otherwise": "warn"})
    page = visit.page
    visit.go(f"jobs/{job}")
    expect(page.get_by_text("4 of 4 holes filled; outer border left open")).to_be_visible()
    report = api.get(f"/v1/jobs/{job}/report")
    unmet = {str(hole["id"]) for hole in report["acceptance"]["unmet"]}
    marked = page.locator("tr[data-hole]").filter(has_text="misses the limits of the rule")
    assert unmet
    assert {row.get_attribute("data-hole") for row in marked.all()} == unmet
    # What the service warns of stands above the picture.
    warning = page.get_by_text(api.get(f"/v1/jobs/{job}")["result"]["warnings"][0]).bounding_box()
    view = page.locator(".workspace").bounding_box()
    assert warning is not None
    assert view is not None
    assert warning["y"] < view["y"]


@pytest.mark.parametrize("locale", ["en-GB", "de-DE"])
def test_places_far_from_zero_differ_and_no_column_is_cut(
    chromium: Browser, local_stack: RunningStack, api: Service, locale: str
) -> None:
    vertices, triangles = punched_relief(32)
    mesh = api.upload(ply_bytes(vertices + np.array([4_512_000.0, 532_100.0, 312.4]), triangles, "double"), "map.ply")
    job = api.repair(mesh)
    for width in (1280, 1440):
        size = {"width": width, "height": 900}
        with visiting(chromium, local_stack.url, locale=locale, viewport=size) as visit:
            for path in (f"meshes/{mesh}", f"jobs/{job}"):
                visit.go(path)
                places = visit.page.locator(".holes td, .holes th").locator(".place")
                expect(places).to_have_count(5)
                assert len(set(places.all_inner_texts())) == 5
                table = visit.page.locator(".holes")
                assert table.evaluate("(table) => table.scrollWidth - table.clientWidth") <= 0, (width, path)


def test_everything_can_be_done_by_keyboard(visit: Visit, api: Service) -> None:
    mesh = api.upload(relief(28), "keyboard.ply")
    page = visit.page
    visit.go(f"meshes/{mesh}")
    expect(page.get_by_role("status").filter(has_text="4 of 4 holes")).to_be_visible()
    page.get_by_role("button", name="Fly to hole 0").focus()
    for _ in range(3):
        page.keyboard.press("n")
    expect(page.get_by_role("button", name="Fly to hole 2")).to_have_attribute("aria-pressed", "true")
    page.keyboard.press("l")
    expect(page.get_by_label("What to do with hole 2")).to_have_value("skip")
    reached = page.get_by_role("button", name="Start the repair")
    for _ in range(60):
        if reached.evaluate("(button) => button === document.activeElement"):
            break
        page.keyboard.press("Tab")
    expect(reached).to_be_focused()
    page.keyboard.press("Enter")
    expect(page).to_have_url(re.compile("#/jobs/"))
    # Focus goes to the new page, as after a link.
    expect(page.locator("main")).to_be_focused()


@pytest.mark.parametrize("colours", ["light", "dark"])
def test_axe_finds_no_violation(chromium: Browser, local_stack: RunningStack, api: Service, colours: str) -> None:
    if not AXE.is_file():
        pytest.skip("the Node.js packages of web/ are not installed; `make test` does")
    mesh = api.upload(relief(30), "axe.ply")
    job = api.repair(mesh)
    with visiting(chromium, local_stack.url, color_scheme=colours) as visit:
        for path in ("scans", "jobs", "batches", "models", "rules", "keys", "about", f"meshes/{mesh}", f"jobs/{job}"):
            visit.go(path)
            expect(visit.page.get_by_role("heading", level=1)).to_be_visible()
            visit.page.wait_for_load_state("networkidle")
            assert visit.violations() == [], path


def test_the_page_speaks_german(chromium: Browser, local_stack: RunningStack) -> None:
    with visiting(chromium, local_stack.url, locale="de-DE") as visit:
        page = visit.page
        visit.go("jobs")
        expect(page.get_by_role("heading", name="Aufträge")).to_be_visible()
        assert page.locator("html").get_attribute("lang") == "de"
        page.get_by_label("Sprache").select_option("English")
        expect(page.get_by_role("heading", name="Jobs")).to_be_visible()
        page.reload()
        expect(page.get_by_role("heading", name="Jobs")).to_be_visible()


def test_what_the_service_says_is_told_in_german(chromium: Browser, local_stack: RunningStack, api: Service) -> None:
    vertices, triangles = punched_relief(33)
    mesh = api.upload(ply_bytes(vertices, np.vstack([triangles, triangles[:2]])), "doppelt.ply")
    job = api.repair(mesh, acceptance={"max_expected_error": 1e-12, "otherwise": "warn"})
    failed = api.repair(mesh, acceptance={"max_expected_error": 1e-12, "otherwise": "fail"})
    broken = api.upload(b"Sehr geehrte Damen und Herren", "brief.ply")
    with visiting(chromium, local_stack.url, locale="de-DE") as visit:
        page, main = visit.page, visit.page.locator("main")

        def sees(path: str, *sentences: str) -> None:
            visit.go(path)
            for sentence in sentences:
                expect(main).to_contain_text(sentence)
            expect(main.locator("[lang=en]:visible")).to_have_count(0)

        copies = "2 Flächen sind genaue Kopien anderer"
        sees(f"meshes/{mesh}", copies)
        sees(
            f"jobs/{job}",
            copies,
            "4 von 4 Löchern gefüllt; äußerer Rand offen gelassen",
            "halten die Grenzen nicht ein",
        )
        sees(f"jobs/{failed}", "Manche Löcher halten die Grenzen der Regel nicht ein.")
        sees(f"meshes/{broken}", "Die Datei ist beschädigt")
        sees("jobs/job_nope", "Diesen Auftrag gibt es nicht")
        sees("models", "general-dictionary@1", "Beschreibung in der Modellkarte (englisch)")
        # What it says in English is there for who opens it.
        visit.go(f"jobs/{job}")
        page.get_by_text("Wortlaut des Dienstes").first.click()
        expect(main.locator("[lang=en]:visible").first).to_have_text(re.compile("exact copies|miss"))
        visit.go("rules")
        page.get_by_label("Name", exact=True).fill("teile")
        page.get_by_label("Weitestes Loch").fill("-1")
        page.get_by_role("button", name="Speichern").click()
        expect(page.get_by_role("alert")).to_contain_text("Ein Wert ist nicht möglich.")
        expect(page.get_by_role("alert")).to_contain_text("muss größer sein als 0")
        expect(main.locator("[lang=en]:visible")).to_have_count(0)


def test_where_keys_are_set_the_page_asks_for_one(
    chromium: Browser, run_stack: Callable[..., AbstractContextManager[RunningStack]]
) -> None:
    with run_stack(QUADPATCH_API_KEYS="the-key-of-station-1") as stack, visiting(chromium, stack.url) as visit:
        page = visit.page
        visit.go("scans")
        expect(page.get_by_role("heading", name="Sign in")).to_be_visible()
        expect(page.get_by_role("navigation")).to_have_count(0)
        assert sum(url.endswith("/v1/limits") for url in visit.asked) == 1
        if AXE.is_file():
            assert visit.violations() == []
        page.get_by_label("Key", exact=True).fill("a-wrong-key")
        page.get_by_role("button", name="Sign in").click()
        expect(page.get_by_role("alert")).to_have_text("This key is not valid.")
        page.get_by_label("Key", exact=True).fill("the-key-of-station-1")
        page.get_by_role("button", name="Sign in").click()
        visit.drop(page.locator(".dropzone"), "behind-keys.ply", relief(22))
        expect(page.get_by_role("heading", level=1)).to_have_text("behind-keys.ply")
        with page.expect_download() as saving:
            page.get_by_role("button", name="Download the scan").click()
        assert Path(saving.value.path()).read_bytes() == relief(22)
        assert page.evaluate("JSON.stringify(localStorage)").count("the-key") == 0
        assert visit.hosts() == {stack.url.removeprefix("http://")}
        page.get_by_role("button", name="Sign out").click()
        expect(page.get_by_role("heading", name="Sign in")).to_be_visible()
