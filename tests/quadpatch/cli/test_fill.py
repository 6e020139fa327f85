"""The command line as a person or a script calls it.

Also tests `quadpatch.cli.calibration_file`, `quadpatch.cli.holes`, `quadpatch.cli.flags`, `quadpatch.cli.messages` and
`quadpatch.cli.reports`.
"""

import hashlib
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from quadpatch.cli.app import app
from quadpatch.cli.fill import summary
from quadpatch.formats.reading import read_scan
from quadpatch.preview import drawing
from tests.quadpatch.filling.gaps import halves
from tests.quadpatch.shapes import bumpy_plate, punched, sphere, write_ply
from tests.waiting import GUARD_S


@pytest.fixture(scope="module")
def scan_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sheet with one border and three holes, the first of them the widest."""
    mesh = punched(bumpy_plate(50, 2.0), (-0.5, -0.5, 0), radius=0.27)
    mesh = punched(mesh, (0.5, 0.4, 0), radius=0.2)
    return write_ply(tmp_path_factory.mktemp("scan") / "sheet.ply", punched(mesh, (0.5, -0.6, 0), radius=0.1))


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def verdicts(report: Path) -> list[str]:
    return [hole["verdict"] for hole in json.loads(report.read_text())["holes"]]


def test_fill_writes_the_mesh_the_report_and_the_picture(scan_file: Path, tmp_path: Path) -> None:
    output, report, picture = tmp_path / "out.ply", tmp_path / "out.json", tmp_path / "out.png"
    files: list[str | Path] = [scan_file, "-o", output, "--report", report, "--preview", picture]
    result = run("fill", *map(str, files), "--model", "smooth")
    assert result.exit_code == 0, result.output
    assert verdicts(report) == ["skipped", "filled_smooth", "filled_smooth", "filled_smooth"]
    assert len(read_scan(output).triangles) > len(read_scan(scan_file).triangles)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert result.stdout == ""
    assert "3 by geometry (3 × no learned model took part), 1 left open (1 × outer border" in " ".join(
        result.stderr.split()
    )


def test_fill_writes_the_report_as_a_page_that_names_both_files(scan_file: Path, tmp_path: Path) -> None:
    output, report, page = tmp_path / "out.ply", tmp_path / "out.json", tmp_path / "out.html"
    result = run("fill", scan_file, "-o", output, "--report", report, "--html", page, "--model", "smooth")
    assert result.exit_code == 0, result.output
    facts = json.loads(report.read_text())["provenance"]
    for file, path in ((facts["source"], scan_file), (facts["output"], output)):
        assert (file["name"], file["sha256"]) == (path.name, hashlib.sha256(path.read_bytes()).hexdigest())
    assert facts["source"]["sha256"] in page.read_text("utf-8")
    assert run("fill", scan_file, "-o", output, "--report", page, "--html", page).exit_code == 1
    without = run("fill", scan_file, "-o", output, "--report", report, "--model", "smooth")
    assert without.exit_code == 0, without.output
    assert "provenance" not in json.loads(report.read_text())


def test_close_ups_are_named_by_the_holes_that_were_chosen(scan_file: Path, tmp_path: Path) -> None:
    files: list[str | Path] = [scan_file, "-o", tmp_path / "out.ply", "--closeups", tmp_path / "closeups"]
    result = run("fill", *files, "--model", "smooth", "--hole", "1", "--hole", "3")
    assert result.exit_code == 0, result.output
    assert {path.name for path in (tmp_path / "closeups").iterdir()} == {"hole_1.png", "hole_3.png"}


def test_a_picture_that_fails_is_a_warning_and_mesh_and_report_are_there(
    scan_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError("slice step cannot be zero")

    monkeypatch.setattr(drawing, "render_before_after", fail)
    output, report = tmp_path / "out.ply", tmp_path / "out.json"
    files: list[str | Path] = [scan_file, "-o", output, "--report", report, "--picture", tmp_path / "out.png"]
    result = run("fill", *files, "--model", "smooth")
    assert result.exit_code == 0, result.output
    assert "Warning: there is no picture: an internal error" in " ".join(result.stderr.split())
    assert "Traceback" not in result.stderr
    assert json.loads(report.read_text())["warnings"] == ["there is no picture: an internal error (ZeroDivisionError)"]
    assert len(read_scan(output).triangles) > len(read_scan(scan_file).triangles)
    assert not (tmp_path / "out.png").exists()


def test_what_calibration_found_out_is_kept_for_the_next_repair_of_the_same_scan(
    scan_file: Path, tmp_path: Path
) -> None:
    kept, report = tmp_path / "calibration.json", tmp_path / "out.json"

    def is_reused(*flags: str | Path) -> bool:
        flags = ("-o", tmp_path / "out.ply", "--report", report, "--calibration", kept, *flags)
        result = run("fill", scan_file, *flags)
        assert result.exit_code == 0, result.output
        return bool(json.loads(report.read_text())["calibration"]["reused"])

    assert not is_reused("--model", "smooth")
    first, meshes = kept.read_bytes(), [(tmp_path / "out.ply").read_bytes()]
    assert is_reused("--model", "smooth")
    meshes.append((tmp_path / "out.ply").read_bytes())
    assert meshes[0] == meshes[1]
    assert kept.read_bytes() == first
    assert not is_reused("--model", "smooth", "--seed", "1")
    assert len(kept.read_bytes()) > len(first)
    assert is_reused("--model", "general-dictionary@1")
    # Nothing is kept unless it is asked for.
    assert sorted(path.name for path in tmp_path.iterdir()) == ["calibration.json", "out.json", "out.ply"]


def test_a_file_that_is_no_file_of_calibrations_is_not_written_over(scan_file: Path, tmp_path: Path) -> None:
    other = tmp_path / "notes.json"
    other.write_text('{"notes": []}')
    for path, words in ((other, "is no file of --calibration"), (scan_file, "is named twice"), ("-", "names a file")):
        result = run("fill", scan_file, "-o", tmp_path / "out.ply", "--calibration", path)
        assert result.exit_code == 1
        assert words in " ".join(result.stderr.split())
    assert other.read_text() == '{"notes": []}'
    assert not (tmp_path / "out.ply").exists()


def test_a_damaged_calibration_is_made_anew(scan_file: Path, tmp_path: Path) -> None:
    kept, flags = tmp_path / "calibration.json", ("-o", tmp_path / "out.ply", "--model", "smooth")
    assert run("fill", scan_file, *flags, "--calibration", kept).exit_code == 0
    sound, mesh = json.loads(kept.read_text()), (tmp_path / "out.ply").read_bytes()
    (record,) = sound["records"].values()
    record["belief"] = 2.0
    kept.write_text(json.dumps(sound))
    assert run("fill", scan_file, *flags, "--calibration", kept).exit_code == 0
    assert (tmp_path / "out.ply").read_bytes() == mesh
    (record,) = json.loads(kept.read_text())["records"].values()
    assert record["belief"] <= 1.0


def test_the_recipe_of_the_paper_has_no_calibration_to_keep(scan_file: Path, tmp_path: Path) -> None:
    flags = ("-o", tmp_path / "out.ply", "--recipe", "paper", "--calibration", tmp_path / "calibration.json")
    result = run("fill", scan_file, *flags)
    assert (result.exit_code, "the paper calibrates nothing" in result.stderr) == (1, True)


def test_the_scan_is_kept_unless_it_may_be_overwritten(scan_file: Path, tmp_path: Path) -> None:
    source = tmp_path / "scan.ply"
    raw = scan_file.read_bytes()
    source.write_bytes(raw)
    (tmp_path / "link.ply").symlink_to(source)
    for output in (source, tmp_path / "link.ply"):
        refused = run("fill", source, "-o", output, "--model", "smooth")
        assert refused.exit_code == 1
        assert refused.stderr.startswith("invalid_option: ")
        assert source.read_bytes() == raw
    assert run("fill", source, "-o", source, "--model", "smooth", "--overwrite").exit_code == 0
    assert len(read_scan(source).triangles) > len(read_scan(scan_file).triangles)


def test_quiet_says_nothing(scan_file: Path, tmp_path: Path) -> None:
    result = run("fill", scan_file, "-o", tmp_path / "out.ply", "--model", "smooth", "--quiet")
    assert (result.exit_code, result.output) == (0, "")


@pytest.mark.parametrize(
    ("flags", "filled"),
    [
        (["--hole", "2"], {2}),
        (["--hole", "3", "--hole", "1"], {1, 3}),
        (["--max-diameter", "0.5"], {2, 3}),
        (["--max-perimeter", "1.0"], {3}),
        (["--max-diameter", "50"], {1, 2, 3}),
        (["--max-diameter", "50", "--include-borders"], {0, 1, 2, 3}),
        (["--rule", "id=2:skip", "--rule", "max_diameter=0.5:smooth"], {1, 3}),
        (["--rule", "kind=hole,min_diameter=0.3:skip"], {3}),
        (["--rule", "skip"], set()),
        (["--all-but-largest"], {1, 2, 3}),
        (["--all-but-largest", "--max-diameter", "0.5", "--hole", "2", "--hole", "1"], {2}),
    ],
)
def test_every_flag_about_holes_chooses_them(
    scan_file: Path, tmp_path: Path, flags: list[str], filled: set[int]
) -> None:
    report = tmp_path / "out.json"
    result = run("fill", scan_file, "-o", tmp_path / "out.ply", "--model", "smooth", "--report", report, *flags)
    assert result.exit_code == 0, result.output
    assert {i for i, verdict in enumerate(verdicts(report)) if verdict != "skipped"} == filled


def test_flags_about_patches_reach_them(scan_file: Path, tmp_path: Path) -> None:
    report = tmp_path / "out.json"
    flags = ["--patch-length", "0.5", "--resolution", "18", "--overlap", "1", "--seed", "3", "--colours", "harmonic"]
    result = run("fill", scan_file, "-o", tmp_path / "out.ply", "--report", report, *flags)
    assert result.exit_code == 0, result.output
    content = json.loads(report.read_text())
    assert content["options"] == {
        "holes": {
            "max_diameter": None,
            "max_perimeter": None,
            "all_but_largest": False,
            "ids": None,
            "include_borders": False,
            "cap": None,
            "rules": [],
            "bridges": [],
        },
        "patches": {"length": 0.5, "resolution": 18, "overlap": 1, "preset": None},
        "weld_tolerance": "auto",
        "colours": "harmonic",
        "seed": 3,
        "recipe": "default",
        "dictionary": {"atoms": None, "nonzero": None},
        "network": {"steps": 800, "seconds": None},
        "effort": "standard",
        "length_unit": None,
        "attributes": None,
    }
    assert content["patches"]["resolution"] == 18
    assert (content["model"]["name"], content["model"]["effort"]) == ("auto", "standard")
    assert content["model"]["not_tried"] == {"general-residual": "its patches have 32 bins along a side, not 18"}
    assert "Not tried: general-residual (its patches have 32 bins" in " ".join(result.stderr.split())


def test_the_effort_fast_is_geometry_alone(scan_file: Path, tmp_path: Path) -> None:
    report = tmp_path / "out.json"
    fast = run("fill", scan_file, "-o", tmp_path / "fast.ply", "--effort", "fast", "--report", report)
    assert fast.exit_code == 0, fast.output
    assert run("fill", scan_file, "-o", tmp_path / "smooth.ply", "--model", "smooth").exit_code == 0
    assert (tmp_path / "fast.ply").read_bytes() == (tmp_path / "smooth.ply").read_bytes()
    content = json.loads(report.read_text())
    assert (content["model"], content["options"]["effort"]) == ({"name": "auto", "effort": "fast"}, "fast")


def test_flags_about_the_recipe_reach_it(scan_file: Path, tmp_path: Path) -> None:
    report = tmp_path / "out.json"
    flags = ["--recipe", "paper", "--atoms", "30", "--nonzero", "5", "--patch-length", "0.3", "--resolution", "12"]
    result = run("fill", scan_file, "-o", tmp_path / "out.ply", "--report", report, *flags)
    assert result.exit_code == 0, result.output
    assert verdicts(report) == ["skipped", "filled", "filled", "filled"]
    assert json.loads(report.read_text())["model"] == {"name": "self"}
    options = json.loads(report.read_text())["options"]
    assert (options["recipe"], options["dictionary"]) == ("paper", {"atoms": 30, "nonzero": 5})
    assert run("fill", scan_file, "-o", tmp_path / "out.ply", "--recipe", "paper", "--model", "smooth").exit_code == 1
    assert run("fill", scan_file, "-o", tmp_path / "out.ply", "--recipe", "ours").exit_code == 2
    preset = run("fill", scan_file, "-o", tmp_path / "out.ply", "--report", report, "--preset", "type2")
    assert preset.exit_code == 0, preset.output
    assert json.loads(report.read_text())["patches"]["resolution"] == 24


def test_holes_are_listed_as_json(scan_file: Path) -> None:
    result = run("holes", scan_file, "--json")
    assert result.exit_code == 0
    facts = json.loads(result.stdout)
    assert [hole["id"] for hole in facts["holes"]] == [0, 1, 2, 3]
    assert [hole["chosen"] for hole in facts["holes"]] == [False, True, True, True]
    assert [hole["action"] for hole in facts["holes"]] == [None, "model", "model", "model"]
    assert [hole["kind"] for hole in facts["holes"]] == ["border", "hole", "hole", "hole"]
    assert facts["holes"][1]["centre"][:2] == pytest.approx([-0.5, -0.5], abs=0.05)
    box = facts["holes"][1]["bounding_box"]
    assert all(
        low < at < high for low, at, high in zip(box["min"], facts["holes"][1]["centre"], box["max"], strict=True)
    )


def test_holes_are_listed_for_people(scan_file: Path) -> None:
    result = run("holes", scan_file)
    assert result.exit_code == 0
    assert "sheet.ply: 4 holes, lengths in mesh units" in result.stdout
    assert result.stdout.count("fill") == 3
    assert max(len(line) for line in result.stdout.splitlines()) <= 100


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["holes", "missing.ply"], "unreadable_mesh"),
        (["fill", "missing.ply", "-o", "out.ply"], "unreadable_mesh"),
        (["fill", "SCAN", "-o", "out.docx"], "unsupported_format"),
        (["fill", "SCAN", "-o", "out.ply", "--hole", "12"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--max-diameter", "-1"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--rule", "id=12:flat"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--rule", "fill"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--rule", "max_diameter=wide:flat"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--rule", "colour=red:flat"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--rule", "kind=window:flat"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--bridge", "1"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--bridge", "1:99"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--bridge", "1:2", "--bridge", "2:3"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--bridge", "1:2", "--recipe", "paper"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--patch-length", "inf"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--resolution", "4"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--weld-tolerance", "near"], "invalid_option"),
        (["holes", "SCAN", "--weld-tolerance", "-1"], "invalid_option"),
        (["holes", "SCAN", "--weld-tolerance", "100"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--seed", "-1"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--model", "no-such-model"], "unusable_model"),
        (["fill", "SCAN", "-o", "out.ply", "--fit-steps", "30"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--model", "smooth", "--fit-seconds", "30"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--model", "self-network", "--fit-steps", "0"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--model", "self-network", "--fit-seconds", "nan"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--model", "self-network", "--recipe", "paper"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--model", "auto", "--recipe", "paper"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--recipe", "paper", "--effort", "best"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--model", "smooth", "--effort", "fast"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--effort", "fast", "--fit-steps", "30"], "invalid_option"),
        (["fill", "SCAN", "-o", "no/such/folder/out.ply", "--model", "smooth"], "not_writable"),
        (["fill", "SCAN", "-o", "out.ply", "--model", "smooth", "--report", "no/such/out.json"], "not_writable"),
        (["fill", "SCAN", "-o", "out.ply", "--model", "smooth", "--picture", "no/such/out.png"], "not_writable"),
        (["fill", "SCAN", "-o", "out.ply", "--model", "smooth", "--report", "out.ply"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--model", "smooth", "--report", "SCAN"], "invalid_option"),
        (["fill", "SCAN", "-o", "SCAN", "--model", "smooth"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--overwrite", "--picture", "SCAN"], "invalid_option"),
        (["fill", "SCAN", "-o", "out.ply", "--closeups", "no/such/folder"], "not_writable"),
        (["fill", "SCAN", "-o", "out.ply", "--closeups", "SCAN"], "not_writable"),
    ],
)
def test_errors_are_one_line_of_code_and_message(
    scan_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], code: str
) -> None:
    monkeypatch.chdir(tmp_path)
    result = run(*[str(scan_file) if argument == "SCAN" else argument for argument in arguments])
    assert result.exit_code == 1, result.output
    assert list(tmp_path.iterdir()) == []
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert re.fullmatch(rf"{code}: .+", line)


@pytest.mark.parametrize("name", ["[red]a.ply", "[bold]a.ply", "a very long name " * 8 + ".ply"])
def test_names_of_files_are_never_taken_for_markup_or_wrapped(tmp_path: Path, name: str) -> None:
    result = run("holes", tmp_path / name)
    assert result.exit_code == 1
    assert result.stderr.startswith("unreadable_mesh: ")
    assert name in result.stderr
    closed = write_ply(tmp_path / name, sphere(1))
    listed = run("holes", closed)
    assert listed.exit_code == 0
    assert name.split(maxsplit=1)[0][:8] in listed.stdout


@pytest.mark.parametrize(
    "arguments", [["fill"], ["fill", "in.ply"], ["fill", "in.ply", "-o", "a.ply", "--hole", "first"], ["mend"]]
)
def test_wrong_usage_has_its_own_exit_code(arguments: list[str]) -> None:
    assert run(*arguments).exit_code == 2


def test_the_summary_counts_reasons() -> None:
    row = {"verdict": "skipped", "reason": "too wide"}
    report = {
        "model": {"name": "self"},
        "counts": {"found": 5, "filled": 1, "filled_smooth": 1, "skipped": 2, "refused": 1},
        "holes": [
            row,
            row,
            {"verdict": "refused", "reason": "no way"},
            {"verdict": "filled", "reason": None},
            {"verdict": "filled_smooth", "reason": "no gain"},
        ],
        "colours": None,
        "warnings": ["beware"],
        "stages": [{"name": "read", "seconds": 1.25}, {"name": "fill", "seconds": 0.5}],
    }
    expected = (
        "5 holes: 1 filled by the model, 1 by geometry (1 × no gain), "
        "3 left open (2 × too wide; 1 × no way). 1.8 s. Warning: beware."
    )
    assert summary(report) == expected
    fitted = {**report, "model": {"name": "self-network", "fitted_from": "general-residual@1"}}
    assert summary(fitted) == expected.replace("the model", "general-residual@1, fitted to this mesh")
    trials = [
        {"models": {}, "believed_share": 0.0, "error": 0.5},
        {"models": {"self": 1.0}, "believed_share": 0.7, "error": 0.44},
    ]
    competed = {**report, "model": {"name": "auto", "shares": {"self": 1.0}, "trials": trials}}
    sentence = "Least error on calibration holes: a dictionary of this mesh, 12 % less than geometry alone."
    assert summary(competed) == expected.replace("1.8 s", f"{sentence} 1.8 s")
    coloured = {**report, "colours": {"method": "exemplars", "calibration": None}}
    assert "left open (2 × too wide; 1 × no way); colours: exemplars. " in summary(coloured)


def test_the_module_runs_as_a_process(scan_file: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "quadpatch", "fill", str(scan_file), "-o", str(tmp_path / "out.stl")]
    done = subprocess.run([*command, "--model", "smooth"], capture_output=True, text=True, check=False, timeout=GUARD_S)
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
    assert read_scan(tmp_path / "out.stl").format == "stl"


def test_a_cut_is_listed_and_closed_only_when_asked_for(tmp_path: Path) -> None:
    gap = halves(0.4, 4)
    scan, report = write_ply(tmp_path / "cut.ply", gap.mesh), tmp_path / "report.json"
    facts = json.loads(run("holes", scan, "--json").stdout)
    assert [(row["holes"], row["shape"]) for row in facts["bridges"]] == [([0, 1], "ring")]
    assert "--bridge 0:1 joins them; by default they are not joined" in " ".join(run("holes", scan).stderr.split())
    plain: list[str | Path] = ["fill", scan, "-o", tmp_path / "out.ply", "--model", "smooth", "--report", report]
    assert run(*plain).exit_code == 0
    assert verdicts(report) == ["skipped"] * 2
    result = run(*plain, "--bridge", "1:0", "--closeups", tmp_path / "closeups")
    assert result.exit_code == 0, result.output
    rows = json.loads(report.read_text())["holes"]
    assert [row["verdict"] for row in rows] == ["filled_smooth"] * 2
    assert [row["code"] for row in rows] == ["bridged", "geometry"]
    assert rows[0]["bridge"] == rows[1]["bridge"]
    assert (rows[0]["bridge"]["holes"], rows[0]["bridge"]["shape"]) == ([1, 0], "ring")
    assert rows[0]["bridge"]["gap"] == pytest.approx(0.45, abs=0.05)
    assert "joined by the bridge 1:0" in " ".join(result.stderr.split())
    assert [path.name for path in (tmp_path / "closeups").iterdir()] == ["hole_1.png"]
