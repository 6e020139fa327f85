import hashlib
import json
import re
from pathlib import Path

import pytest

from deploy.lock import EXTRAS, read_lock
from deploy.sbom import bill_of_materials, main

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("extras", [("service",), EXTRAS])
def test_the_bill_names_everything_that_the_locks_hold(extras: tuple[str, ...]) -> None:
    document = bill_of_materials(extras)
    libraries = {c["name"]: c for c in document["components"] if c.get("purl", "").startswith("pkg:pypi/")}
    locked = {name: pin for extra in extras for name, pin in read_lock(extra).items()}
    assert {n: (c["version"], c["hashes"][0]["content"]) for n, c in libraries.items()} == locked
    assert {c["purl"] for c in libraries.values()} == {f"pkg:pypi/{n}@{version}" for n, (version, _) in locked.items()}


def test_references_are_unique_and_lead_to_components() -> None:
    document = bill_of_materials(EXTRAS)
    project = document["metadata"]["component"]
    references = [project["bom-ref"], *(component["bom-ref"] for component in document["components"])]
    assert len(references) == len(set(references))
    edges = {entry["ref"]: entry["dependsOn"] for entry in document["dependencies"]}
    assert set(edges) <= set(references)
    assert all(set(targets) <= set(references) for targets in edges.values())
    # What the project asks for leads to every distribution of the locks.
    reached, left = set(), [project["bom-ref"]]
    while left:
        reference = left.pop()
        if reference not in reached:
            reached.add(reference)
            left += edges[reference]
    python = [component for component in document["components"] if not component["bom-ref"].startswith("pkg:npm/")]
    unreached = {component["name"] for component in python if component["bom-ref"] not in reached}
    assert {name for name in unreached if not name.startswith(("nvidia-", "cuda-", "general-"))} <= {"triton"}


def test_the_libraries_of_the_page_are_named() -> None:
    scripts = {
        component["name"]: component
        for component in bill_of_materials()["components"]
        if component["bom-ref"].startswith("pkg:npm/")
    }
    wanted = json.loads((ROOT / "web/package.json").read_text("utf-8"))["dependencies"]
    assert {name: scripts[name]["version"] for name in wanted} == wanted
    assert "typescript" not in scripts
    assert all(re.fullmatch("[0-9a-f]{128}", script["hashes"][0]["content"]) for script in scripts.values())


def test_the_models_that_ship_are_named_with_their_hashes() -> None:
    models = {
        f"{component['name']}@{component['version']}": component["hashes"][0]["content"]
        for component in bill_of_materials()["components"]
        if component["type"] == "machine-learning-model"
    }
    files = [p for p in (ROOT / "quadpatch/shipped_models").iterdir() if p.suffix in (".safetensors", ".onnx")]
    assert models == {path.stem: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def test_most_libraries_state_a_licence_and_the_project_its_own() -> None:
    document = bill_of_materials()
    libraries = [component for component in document["components"] if component["type"] == "library"]
    assert len([component for component in libraries if "licenses" in component]) >= 0.8 * len(libraries)
    assert document["metadata"]["component"]["licenses"] == [{"expression": "GPL-3.0-or-later"}]


def test_the_same_locks_give_the_same_bytes(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == main([]) == 0
    first, second = re.findall(r"^\{$.*?^\}$", capsys.readouterr().out, re.MULTILINE | re.DOTALL)
    assert first == second
    assert json.loads(first)["bomFormat"] == "CycloneDX"


def test_an_unknown_extra_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["dev"]) == 2
    assert "no such extra: dev" in capsys.readouterr().err
