"""Registers the models that ship with the project; a second time changes nothing."""

import json
import logging
import re
from pathlib import Path

from jobkit.errors import ModelNotFoundError, NameTakenError
from jobkit.models.default_aliases import DEFAULT_KINDS
from jobkit.models.registry import Registry
from jobkit.models.resolution import learned_for
from quadpatch_client.schema import DEFAULT_PAPER_MODEL, DEFAULT_PAPER_NETWORK, ModelVersion
from quadpatch_rules.ids import MODEL_NAME

_FILE = re.compile(rf"^(?P<name>{MODEL_NAME})@(?P<version>[1-9][0-9]*)\.(?:safetensors|onnx)$")
_logger = logging.getLogger(__name__)


def seed_shipped(registry: Registry, folder: Path) -> list[ModelVersion]:
    """Register every `name@version.safetensors` and `name@version.onnx` of a folder.

    Models bring their cards; a network without one may have it beside it as `name@version.json`. They are taken as
    proven: tests prove those that ship, and others are the choice of the operator. Where the aliases `default`,
    `default-network`, `default-paper` and `default-paper-network` point to nothing yet, they are pointed to the latest
    version of the first dictionary or network of their recipe that is not deprecated. A version that was deleted stays
    deleted.

    Parameters
    ----------
    registry : Registry
    folder : Path
        One that does not exist holds no models.

    Returns
    -------
    list of ModelVersion
        By file name, whether new or registered before.

    Raises
    ------
    UnusableModelError
        If a file is no model.
    """
    versions = []
    for path in sorted(folder.glob("*@*")) if folder.is_dir() else []:
        match = _FILE.match(path.name)
        if match is None:
            continue
        card_path = path.with_suffix(".json")
        card = json.loads(card_path.read_text("utf-8")) if path.suffix == ".onnx" and card_path.is_file() else None
        try:
            version, _ = registry.publish_file(match["name"], path, card, int(match["version"]))
        except NameTakenError as error:
            # Jobs are pinned to what is registered; a changed file without a new number must not change them.
            _logger.warning("shipped model %s is not registered: %s", path.name, error)
            continue
        versions.append(version)
    of_the_paper = (DEFAULT_PAPER_MODEL, DEFAULT_PAPER_NETWORK)
    for alias, kind in DEFAULT_KINDS.items():
        fitting = [v for v in versions if v.kind == kind and (learned_for(v) == "paper") is (alias in of_the_paper)]
        _point_default(registry, alias, fitting)
    return versions


def _point_default(registry: Registry, alias: str, versions: list[ModelVersion]) -> None:
    try:
        registry.resolve(alias)
    except ModelNotFoundError:
        usable = [version for version in versions if version.deprecated is None]
        if usable:
            latest = max(version.version for version in usable if version.name == usable[0].name)
            registry.set_alias(alias, f"{usable[0].name}@{latest}")
