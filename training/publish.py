"""Publishing a model in the registry that the service and the workers use."""

import re
from pathlib import Path

from jobkit.database.session import Database
from jobkit.models.registry import Registry
from jobkit.settings import load_settings
from jobkit.storage.open import open_store
from quadpatch.errors import OptionError
from quadpatch.inpainters.proof import prove_model
from quadpatch_client.schema import ModelVersion
from quadpatch_rules.ids import MODEL_NAME


def parse_reference(text: str) -> tuple[str, int | None]:
    """Part `name` or `name@version`.

    Raises
    ------
    OptionError
        If it is neither, or no name that a registry takes.
    """
    match = re.fullmatch(rf"(?P<name>{MODEL_NAME})(?:@(?P<version>[1-9][0-9]*))?", text)
    if match is None:
        raise OptionError(f"{text!r} is no name of a model; use small letters, digits, dots and dashes, then @version")
    return match["name"], int(match["version"]) if match["version"] else None


def publish(name: str, version: int | None, path: Path) -> ModelVersion:
    """Register a model file as that version of a name, or as the next one.

    The registry is the one that the QUADPATCH_ environment variables point to, as they do for the service; it may be
    running meanwhile.

    Raises
    ------
    JobkitError
        If a setting is wrong, the name or the version is taken, or the registry can't be reached.
    ModelError
        If the file is no model that a repair can use.
    """
    prove_model(path)
    settings = load_settings()
    settings.data_dir.mkdir(parents=True, exist_ok=True)
    database = Database(settings.effective_database_url)
    database.migrate()
    try:
        registry = Registry(database, open_store(settings.effective_object_store_url, settings.scratch_dir))
        return registry.publish_file(name, path, version=version)[0]
    finally:
        database.close()
