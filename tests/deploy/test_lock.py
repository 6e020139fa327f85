import re
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from deploy.lock import BUILD, EXTRAS, LOCKS, LockError, lock_text, read_lock, requirements

ROOT = Path(__file__).resolve().parents[2]


def pins() -> dict[str, str]:
    lines = (line.split("==") for line in (ROOT / "constraints.txt").read_text("utf-8").split())
    return {canonicalize_name(name): version for name, version in lines}


def needed(extra: str) -> set[str]:
    """Everything that the requirements of an extra lead to, as far as the metadata of what is installed says it."""
    found: set[str] = set()
    left = [Requirement(text) for text in requirements(extra)]
    while left:
        requirement = left.pop()
        name = canonicalize_name(requirement.name)
        if name not in found:
            found.add(name)
            left += asked_by(name, requirement.extras)
    return found


def asked_by(name: str, extras: set[str]) -> list[Requirement]:
    try:
        asked = [Requirement(text) for text in requires(name) or []]
    except PackageNotFoundError:
        return []
    return [r for r in asked if r.marker is None or any(r.marker.evaluate({"extra": e}) for e in ("", *extras))]


@pytest.mark.parametrize("extra", [BUILD, *EXTRAS])
def test_a_lock_holds_all_that_is_needed_with_one_hash_each(extra: str) -> None:
    lines = (LOCKS / f"{extra}.txt").read_text("utf-8").splitlines()
    assert lines[0].startswith("# Written by `make lock`")
    assert all(re.fullmatch(r"[a-z0-9.-]+==[\w.]+ --hash=sha256:[0-9a-f]{64}", line) for line in lines[1:])
    assert lines[1:] == sorted(lines[1:])
    assert needed(extra) <= set(read_lock(extra))


@pytest.mark.parametrize("extra", [BUILD, *EXTRAS])
def test_a_lock_pins_what_the_tests_run_with(extra: str) -> None:
    tested = pins()
    locked = {name: version for name, (version, _) in read_lock(extra).items()}
    assert {name: locked[name] for name in locked.keys() & tested} == {
        name: tested[name] for name in locked.keys() & tested
    }
    # The tests run with torch for processors, which comes without the libraries of graphics cards.
    untested = {name for name in locked.keys() - tested if not name.startswith(("nvidia-", "cuda-"))}
    assert untested <= {"triton"}


def test_locks_agree_where_they_meet() -> None:
    seen: dict[str, tuple[str, str]] = {}
    for extra in EXTRAS:
        for name, pin in read_lock(extra).items():
            assert seen.setdefault(name, pin) == pin


def test_the_image_installs_nothing_that_is_in_no_lock() -> None:
    dockerfile = (ROOT / "Dockerfile").read_text("utf-8")
    installs = re.findall(r"pip install .*", dockerfile)
    assert len(installs) == 2
    assert "--require-hashes --no-deps" in installs[0]
    assert "--no-deps --no-build-isolation ./client ." in installs[1]
    assert "pip check" in dockerfile


@pytest.mark.parametrize(
    ("version", "archive"),
    [("1.0+cpu", {"hashes": {"sha256": "0" * 64}}), ("1.0", {}), ("1.0", {"hashes": {}})],
)
def test_what_no_public_index_holds_gets_into_no_lock(version: str, archive: dict[str, object]) -> None:
    item = {"metadata": {"name": "x", "version": version}, "download_info": {"archive_info": archive}}
    with pytest.raises(LockError, match="no file of a public index"):
        lock_text({"install": [item]})


def test_a_lock_is_sorted_and_named_as_indexes_do() -> None:
    def item(name: str) -> dict[str, object]:
        return {
            "metadata": {"name": name, "version": "1.0"},
            "download_info": {"archive_info": {"hashes": {"sha256": "0" * 64}}},
        }

    text = lock_text({"install": [item("PyYAML"), item("a_b")]})
    assert [line.split("==")[0] for line in text.splitlines()[1:]] == ["a-b", "pyyaml"]
