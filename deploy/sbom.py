"""A bill of materials of the image: CycloneDX 1.6 as JSON, from the locks.

`python -m deploy.sbom [EXTRA …]` prints it; without extras for the image that the Dockerfile builds by default. It
names every distribution with its version and sha256, which of them needs which, the libraries that the page was built
from, and the models that ship. Licences are those that the installed distributions and the lock of the page state. The
packages of the base image's system are not in it. The same locks give the same bytes.
"""

import hashlib
import json
import re
import sys
import tomllib
import uuid
from base64 import b64decode
from collections.abc import Iterable, Iterator
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from typing import Any
from urllib.parse import quote

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from deploy.lock import EXTRAS, ROOT, read_lock, requirements

Component = dict[str, Any]
_DEFAULT_EXTRAS = ("service",)
_PAGE_LOCK = ROOT / "web" / "package-lock.json"
_MODELS = ROOT / "quadpatch" / "shipped_models"
_MODEL_FILE = re.compile(r"(?P<name>[\w-]+)@(?P<version>\d+)\.(safetensors|onnx)")


def bill_of_materials(extras: Iterable[str] = _DEFAULT_EXTRAS) -> dict[str, Any]:
    """Return the bill of materials of an image with these extras.

    Parameters
    ----------
    extras : iterable of str
        As `EXTRAS` of the Dockerfile names them.
    """
    locked: dict[str, tuple[str, str]] = {}
    for extra in extras:
        locked |= read_lock(extra)
    project = _project()
    libraries = [_library(name, version, sha256) for name, (version, sha256) in sorted(locked.items())]
    scripts, models = list(_scripts()), list(_models())
    document: dict[str, Any] = {
        "$schema": "http://cyclonedx.org/schema/bom-1.6.schema.json",
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": {"component": project},
        "components": [*libraries, *scripts, *models],
        "dependencies": list(_dependencies(project["bom-ref"], locked, list(extras))),
    }
    digest = hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()
    return {**document, "serialNumber": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, digest)}"}


def _project() -> Component:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    return {
        "type": "application",
        "bom-ref": _reference(project["name"], project["version"]),
        "name": project["name"],
        "version": project["version"],
        "description": project["description"],
        "licenses": [{"expression": project["license"]}],
        "purl": _reference(project["name"], project["version"]),
    }


def _library(name: str, version: str, sha256: str) -> Component:
    licences = _licences(name, version)
    return {
        "type": "library",
        "bom-ref": _reference(name, version),
        "name": name,
        "version": version,
        "hashes": [{"alg": "SHA-256", "content": sha256}],
        **({"licenses": licences} if licences else {}),
        "purl": _reference(name, version),
    }


def _scripts() -> Iterator[Component]:
    """Yield the libraries that the page was built from, as its lock has them."""
    packages = json.loads(_PAGE_LOCK.read_text("utf-8"))["packages"]
    for path, package in sorted(packages.items()):
        if not path or package.get("dev"):
            continue
        name = path.rpartition("node_modules/")[2]
        purl = f"pkg:npm/{quote(name, safe='/')}@{package['version']}"
        algorithm, _, digest = package["integrity"].partition("-")
        yield {
            "type": "library",
            "bom-ref": purl,
            "name": name,
            "version": package["version"],
            "hashes": [{"alg": algorithm.upper().replace("SHA", "SHA-"), "content": b64decode(digest).hex()}],
            **({"licenses": [{"expression": package["license"]}]} if "license" in package else {}),
            "purl": purl,
        }


def _models() -> Iterator[Component]:
    """Yield the model files that are part of the package."""
    for path in sorted(_MODELS.iterdir()):
        match = _MODEL_FILE.fullmatch(path.name)
        if match:
            yield {
                "type": "machine-learning-model",
                "bom-ref": f"model:{match['name']}@{match['version']}",
                "name": match["name"],
                "version": match["version"],
                "hashes": [{"alg": "SHA-256", "content": hashlib.sha256(path.read_bytes()).hexdigest()}],
            }


def _dependencies(project: str, locked: dict[str, tuple[str, str]], extras: list[str]) -> Iterator[dict[str, Any]]:
    """Yield which distribution needs which, as far as they are in the locks."""
    references = {name: _reference(name, version) for name, (version, _) in locked.items()}
    direct = sorted({text for extra in extras for text in requirements(extra)})
    extras_of: dict[str, set[str]] = {canonicalize_name(r.name): r.extras for r in map(Requirement, direct)}
    yield {"ref": project, "dependsOn": _locked_references(direct, references, set())}
    for name in sorted(references):
        installed = _installed(name)
        needed = installed.requires or [] if installed else []
        yield {"ref": references[name], "dependsOn": _locked_references(needed, references, extras_of.get(name, set()))}


def _locked_references(requirements: Iterable[str], references: dict[str, str], extras: set[str]) -> list[str]:
    """Return what applies to the image and is in its locks."""
    names = {
        canonicalize_name(requirement.name)
        for requirement in map(Requirement, requirements)
        if any(requirement.marker is None or requirement.marker.evaluate({"extra": e}) for e in ("", *extras))
    }
    return sorted(references[name] for name in names if name in references)


def _licences(name: str, version: str) -> list[dict[str, Any]]:
    """Return what an installed distribution of that version states: an SPDX expression, or a name."""
    installed = _installed(name)
    if installed is None or installed.version.split("+")[0] != version:
        return []
    metadata = installed.metadata.json
    expression, text = metadata.get("license_expression"), metadata.get("license")
    if expression:
        return [{"expression": expression}]
    classifiers = [line.rsplit(" :: ", 1)[-1] for line in metadata.get("classifier", []) if "License" in line]
    # Some put the whole text of their licence here.
    names = classifiers or ([text] if isinstance(text, str) and len(text) < 100 and "\n" not in text else [])
    return [{"license": {"name": name}} for name in names]


def _installed(name: str) -> Distribution | None:
    try:
        return distribution(name)
    except PackageNotFoundError:
        return None


def _reference(name: str, version: str) -> str:
    """Return the package URL, which is the name of a component within the document too."""
    return f"pkg:pypi/{name}@{version}"


def main(arguments: list[str]) -> int:
    """Print the bill of materials; return the exit code."""
    unknown = set(arguments) - set(EXTRAS)
    if unknown:
        sys.stderr.write(f"no such extra: {', '.join(sorted(unknown))}; there are {', '.join(EXTRAS)}\n")
        return 2
    sys.stdout.write(json.dumps(bill_of_materials(arguments or _DEFAULT_EXTRAS), indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
