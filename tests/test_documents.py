"""The documents, held to the code they speak of."""

import ast
import importlib
import re
import tomllib
from collections.abc import Iterator
from http import HTTPStatus
from pathlib import Path
from typing import TypeVar

import pytest
import yaml
from PIL import Image

import jobkit.errors
import quadpatch.errors
from jobkit.settings import settings_table
from onebox.demo import find_scan
from quadpatch.calibration import calibration_set, energy_selection, error_model
from quadpatch.filling import fill, triangulation
from quadpatch.inpainters import dictionary, paper_dictionary
from quadpatch.mesh import hole_kinds, slits
from quadpatch.patches import paper_layout, ray_visibility, scale
from quadpatch.recipes import assessment, default, fairing_energies, paper
from quadpatch.report import VERDICTS
from quadpatch.sparse import gaussian
from quadpatch_client.cli import app as client_app
from quadpatch_client.exit_codes import MEANINGS
from quadpatch_client.schema import STAGES, JobState
from quadpatch_client.schema.codes import FAILURE_CODES
from quadpatch_rules.coded_warnings import OTHER, WARNINGS
from service.contract.codes import problem_codes
from service.problems import to_problem_error

E = TypeVar("E", bound=Exception)
ROOT = Path(__file__).resolve().parent.parent
DOCUMENTS = [
    ROOT / "README.md",
    ROOT / "SECURITY.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "CHANGELOG.md",
    *sorted((ROOT / "docs").rglob("*.md")),
]
PACKAGES = ("quadpatch", "jobkit", "service", "worker", "training", "client", "onebox", "benchmarks", "tests")
# Only bases of others; nothing raises them.
BASES = {"quadpatch_error", "invalid_mesh", "jobkit_error", "not_found", "conflict", "quota_exceeded"}
# They stop a process or an attempt, and reach no client.
INNER = {"invalid_settings", "stale_attempt", "memory_full", "tenant_busy"}


def read(path: str) -> str:
    return (ROOT / path).read_text("utf-8")


def rows(document: str) -> dict[str, list[str]]:
    """Rows of all tables by their first cell, without its backticks."""
    lines = [line.strip("| ").split(" | ") for line in document.splitlines() if line.startswith("| ")]
    return {cells[0].strip("` "): [cell.strip() for cell in cells[1:]] for cells in lines}


def all_classes(base: type[E]) -> Iterator[type[E]]:
    yield base
    for child in base.__subclasses__():
        yield from all_classes(child)


def codes_in_calls(folder: str, *functions: str) -> set[str]:
    """Codes written out in calls of these functions: a snake-case string among the arguments."""
    found = set()
    for path in (ROOT / folder).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in functions:
                values = [*node.args, *(keyword.value for keyword in node.keywords if keyword.arg == "code")]
                found |= {v.value for v in values if isinstance(v, ast.Constant) and isinstance(v.value, str)}
    return {code for code in found if re.fullmatch(r"[a-z]+(_[a-z]+)+|unauthorized", code)}


def test_every_code_of_the_contract_stands_in_the_table_with_its_status() -> None:
    table = rows(read("docs/api.md"))
    for kind in all_classes(jobkit.errors.JobkitError):
        code = vars(kind)["code"]
        if code in BASES | INNER:
            continue
        status = to_problem_error(kind("")).status
        assert status != HTTPStatus.INTERNAL_SERVER_ERROR, code
        if code not in (
            "unusable_model",
            "mesh_encoded",
            "store_unavailable",
        ):  # stand in both tables; the later row wins in `rows`
            assert table[code][0] == str(status.value), code


def test_every_code_of_the_method_stands_in_the_table() -> None:
    codes = {vars(kind)["code"] for kind in all_classes(quadpatch.errors.QuadpatchError)} - BASES
    assert codes <= set(rows(read("docs/api.md")))


def test_every_code_that_service_and_worker_write_out_stands_in_the_table() -> None:
    codes = codes_in_calls("service", "ProblemError")
    codes |= codes_in_calls("worker", "Failure", "JobError")
    codes |= codes_in_calls("jobkit", "JobError", "MeshProblem", "ModelProblem")
    assert {
        "proof_failed",
        "unauthorized",
        "internal_error",
        "engine_crashed",
        "worker_lost",
        "analysis_failed",
    } <= codes
    assert codes <= set(rows(read("docs/api.md")))


def test_the_tables_of_codes_are_those_of_the_document() -> None:
    """The table of warnings behind them belongs to the report."""
    document = read("docs/api.md")
    tables = document[document.index("| code | status | meaning |") :].split("\n\n")
    assert set(rows(tables[0])) - {"code", "---"} == set(problem_codes())
    assert set(rows(tables[2])) - {"code", "---"} == set(FAILURE_CODES)
    warnings = document[document.index("| code | warning |") :].split("\n\n")[0]
    assert set(rows(warnings)) - {"code", "---"} == {*WARNINGS, OTHER}


def test_every_state_verdict_and_stage_is_explained() -> None:
    assert {state.value for state in JobState} <= set(rows(read("docs/api.md")))
    assert set(VERDICTS) <= set(rows(read("docs/method.md")))
    assert set(VERDICTS) <= set(rows(read("README.md")))
    assert set(STAGES) <= set(rows(read("docs/architecture.md")))


def test_every_reason_of_a_hole_is_explained() -> None:
    method = read("docs/method.md")
    source = read("client/quadpatch_rules/hole_selection.py") + read("quadpatch/recipes/assessment.py")
    # A code is followed by a sentence, or stands behind its verdict.
    reasons = re.findall(r'"([a-z_]+)",\s*f?"[^"]* [^"]*"', source)
    reasons += re.findall(r'"(?:filled_smooth|refused)", "(\w+)"', source)
    assert {"too_wide", "border", "no_gain", "no_triangulation"} <= set(reasons)
    assert not [reason for reason in reasons if f"`{reason}`" not in method]


def sections(document: str, name: str) -> str:
    """Return the sections that name a file or a word in backticks."""
    return "\n".join(part for part in re.split(r"^## ", document, flags=re.MULTILINE) if f"`{name}`" in part)


def numbers(text: str) -> set[float]:
    """Return all numbers of a text; a comma parts thousands."""
    return {float(number.replace(",", "")) for number in re.findall(r"\d+(?:,\d{3})*(?:\.\d+)?", text)}


# Where it stands in the document: a file that the section names.
NUMBERS_OF_THE_METHOD: dict[str, set[float]] = {
    "quadpatch/mesh/hole_kinds.py": {
        hole_kinds.OUTWARD,
        hole_kinds.LEAST_ROUNDNESS,
        hole_kinds.END_PLANARITY,
        hole_kinds.END_STEEPNESS,
        hole_kinds.END_BEYOND,
    },
    "quadpatch/mesh/slits.py": {100 * slits.SLIT_SHARE, slits.SLIT_WIDTH, slits.SLIT_WAY},
    "quadpatch/filling/triangulation.py": {triangulation.MAX_TABLE_SIZE},
    "quadpatch/calibration/calibration_set.py": {
        *(energy.variation / energy.plate for energy in fairing_energies.FAIRING_ENERGIES[2:]),
        *(energy.membrane / energy.plate for energy in fairing_energies.FAIRING_ENERGIES[:2]),
        *(energy.slope for energy in fairing_energies.FAIRING_ENERGIES),
        default.WIDEST_CALIBRATION,
        energy_selection.AS_WIDE,
        calibration_set.MIN_HOLES,
        calibration_set.MAX_HOLES,
        calibration_set.MORE_HOLES,
    },
    "quadpatch/recipes/model_trials.py": set(calibration_set.SHARES),
    "quadpatch/patches/scale.py": {
        scale.HOLES_PER_LENGTH,
        scale.EDGES_PER_BIN,
        *scale.RESOLUTION_RANGE,
        scale.OVERLAP,
        scale.BASE_SURFACE_SHARE,
        *scale.BASE_SURFACE_ITERATIONS_RANGE,
    },
    "quadpatch/patches/height_map.py": {ray_visibility.LEAST_FACING},
    "quadpatch/sparse/gaussian.py": {
        gaussian.NOISE,
        dictionary.PRINCIPAL_ATOMS,
        dictionary.MIN_TRAINING_PATCHES,
    },
    "quadpatch/recipes/assessment.py": {
        100 * assessment.LEAST_COVERAGE,
        assessment.MOST_INCONSISTENCY,
        assessment.DOUBTFUL_SHARE,
        100 * assessment.DOUBTFUL_SHARE,
        10 * assessment.DOUBTFUL_SHARE,
        round(assessment.confidence(assessment.DOUBTFUL_SHARE, 1.0), 2),
        round(assessment.confidence(0.1 * assessment.DOUBTFUL_SHARE, 1.0), 2),
    },
    "quadpatch/calibration/error_model.py": {
        fill.ALTERNATIVE_ENERGY.variation / fill.ALTERNATIVE_ENERGY.plate,
        error_model.PRIOR_SLOPE,
        error_model.WEIGHT,
        error_model.PRIOR.slope,
        error_model.PRIOR.factor,
    },
    "quadpatch/recipes/paper.py": {
        paper_layout.SMOOTHING_ITERATIONS,
        paper.HOLES_PER_LENGTH,
        paper.LEAST_EDGES_PER_BIN,
        paper.RESOLUTION,
        paper.OVERLAP,
    },
    "quadpatch/inpainters/paper_dictionary.py": {
        paper_dictionary.LOCAL_ATOMS,
        paper_dictionary.GLOBAL_ATOMS,
        paper_dictionary.NONZERO,
        paper_dictionary.ITERATIONS,
        paper_dictionary.MAX_TRAINING_PATCHES,
        100 * paper_layout.LEAST_KNOWN,
    },
}


@pytest.mark.parametrize("path", NUMBERS_OF_THE_METHOD)
def test_the_numbers_of_the_method_are_those_of_the_code(path: str) -> None:
    found = numbers(sections(read("docs/method.md"), path))
    assert {float(f"{number:g}") for number in NUMBERS_OF_THE_METHOD[path]} <= found


def test_the_exit_codes_are_those_of_the_client() -> None:
    (part,) = [part for part in read("docs/api.md").split("\n## ") if part.startswith("Exit codes")]
    assert {row for row in rows(part) if row.isdigit()} == {str(code.value) for code in MEANINGS}


def test_every_endpoint_is_listed() -> None:
    document = yaml.safe_load(read("openapi.yaml"))
    served = {f"{m.upper()} {path}" for path, item in document["paths"].items() for m in item if m != "parameters"}
    listed = {row for row in rows(read("docs/api.md")) if re.match(r"(GET|POST|PUT|PATCH|DELETE|OPTIONS) /", row)}
    assert listed == served


def test_the_settings_table_is_that_of_the_code() -> None:
    assert settings_table() in read("docs/operations/configure.md")


def test_make_targets_that_are_named_exist() -> None:
    targets = set(re.findall(r"^(\w+):", read("Makefile"), re.MULTILINE))
    for path in DOCUMENTS:
        named = set(re.findall(r"(?:^|`)make (\w+)", path.read_text("utf-8"), re.MULTILINE))
        assert named <= targets, path.name


def test_commands_of_the_client_that_are_named_exist() -> None:
    known = {c.name or getattr(c.callback, "__name__", "") for c in client_app.registered_commands}
    known |= {str(group.typer_instance and group.typer_instance.info.name) for group in client_app.registered_groups}
    for path in DOCUMENTS:
        named = re.findall(r"quadpatch-client ([a-z]+)\b(?! to\b)", path.read_text("utf-8"))
        assert set(named) <= known, path.name


def test_commands_that_are_named_exist() -> None:
    for path in DOCUMENTS:
        for module, command in re.findall(r"python -m ([\w.]+)(?: ([a-z]+)\b)?", path.read_text("utf-8")):
            file = ROOT / module.replace(".", "/")
            is_there = (file / "__main__.py").is_file() or file.with_suffix(".py").is_file()
            assert is_there or module in ("venv", "pip"), f"{path.name}: {module}"
            apps = {"quadpatch": "quadpatch.cli.app", "training": "training.__main__", "onebox": "onebox.__main__"}
            if command and module in apps:
                app = importlib.import_module(apps[module]).app
                known = {c.name or c.callback.__name__ for c in app.registered_commands}
                assert command in known | {"and"}, f"{path.name}: {module} {command}"


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_files_and_headings_that_are_named_exist(path: Path) -> None:
    text = path.read_text("utf-8")
    for link in re.findall(r"\]\((?!https://)([^)#]*)(?:#([^)]+))?\)", text):
        target = path.parent / link[0] if link[0] else path
        assert target.exists(), link
        if link[1]:
            headings = re.findall(r"^#+ (.+)$", target.read_text("utf-8"), re.MULTILINE)
            assert link[1] in {re.sub(r"[^\w -]", "", h).strip().lower().replace(" ", "-") for h in headings}, link
    for name in re.findall(r"`([\w./@-]+)`", text):
        if name.split("/")[0] in PACKAGES and "/" in name:
            assert (ROOT / name).exists(), name


def test_the_picture_is_small_enough_for_a_page() -> None:
    path = ROOT / "docs/images/before_after.png"
    assert path.stat().st_size < 300_000
    with Image.open(path) as picture:
        assert min(picture.size) >= 500


@pytest.mark.parametrize("package", ["quadpatch", "jobkit"])
def test_the_order_inside_a_package_is_that_of_its_contract(package: str) -> None:
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]["contracts"]
    (layers,) = [contract["layers"] for contract in contracts if contract.get("containers") == [package]]
    text = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    block = text.partition(f"Inside `{package}`")[2].split("```\n")[1]
    assert [re.split(r"\s{2,}", line)[0] for line in block.splitlines()] == layers


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_no_line_of_prose_is_over_120_long(path: Path) -> None:
    made = re.compile(r"^```.*?^```|^<!-- results: .*?^<!-- end of results -->", re.DOTALL | re.MULTILINE)
    prose = made.sub("", path.read_text("utf-8"))
    assert not [line for line in prose.splitlines() if len(line) > 120 and not line.startswith(("|", "    "))]


def test_every_decision_is_listed_with_its_date() -> None:
    listed = dict(re.findall(r"^\| \[.+\]\(decisions/(.+)\) \| (\S+) \|$", read("docs/architecture.md"), re.MULTILINE))
    pages = {path.name: path.read_text("utf-8") for path in (ROOT / "docs/decisions").glob("*.md")}
    assert listed == {name: re.findall(r"^Decided (\S+)\.$", page, re.MULTILINE)[0] for name, page in pages.items()}


def test_results_name_a_command_for_every_run_that_is_put_into_them() -> None:
    results = read("docs/results.md").replace("\\\n", "")
    (assembled,) = re.findall(r"benchmarks\.quality\.assemble docs/results\.md(.+)", results)
    runs = dict(run.split("=") for run in assembled.split())
    assert set(runs) == set(re.findall(r"<!-- results: ([\w-]+)/", results))
    assert set(runs.values()) == set(re.findall(r'make bench-quality .*--output (\S+)"', results))


def test_the_scan_of_the_first_request_is_that_of_the_demo() -> None:
    (path,) = re.findall(r"cp \.\./\.venv/lib/python3\*/site-packages/(\S+) scan\.ply", read("README.md"))
    assert find_scan().as_posix().endswith(f"/site-packages/{path}")
