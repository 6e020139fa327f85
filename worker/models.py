"""The file of the model that a job is pinned to, fetched once and verified."""

import hashlib
import os
import tempfile
from pathlib import Path
from typing import Any

from jobkit.errors import NotFoundError
from jobkit.models.registry import Registry
from jobkit.storage.base import CHUNK_BYTES, ObjectStore
from jobkit.storage.digests import sha256_of
from quadpatch_client.schema import Deprecation, ResolvedModel
from worker.failures import EngineFailedError, Failure

# What `quadpatch.repair.repair_file` calls the ways to fill a hole without a model file.
_WITHOUT_FILE = {"none": "smooth", "self": "self", "self_network": "self-network", "auto": "auto"}


def model_argument(model: ResolvedModel, registry: Registry, store: ObjectStore, cache: Path) -> str:
    """Return the model argument of the engine.

    Parameters
    ----------
    model : ResolvedModel
        The version that the job is pinned to.
    registry : Registry
    store : ObjectStore
    cache : Path
        Folder of fetched models, named by their sha256; shared by all workers of a machine.

    Raises
    ------
    EngineFailedError
        If the version is gone from the store, or its bytes have changed.
    """
    if model.kind in _WITHOUT_FILE:
        return _WITHOUT_FILE[model.kind]
    if model.name is None or model.version is None:
        raise EngineFailedError(Failure("model_missing", "the job is pinned to no version of a model"))
    try:
        artifact = registry.artifact(model.name, model.version)
        path = cache / f"{artifact.sha256}.{artifact.format}"
        # A disk may lose bits in the cache as well.
        if not path.exists() or sha256_of(path) != artifact.sha256:
            _fetch(store, artifact.key, artifact.sha256, path)
    except NotFoundError as error:
        message = f"model {model.name}@{model.version} is gone from the registry or the store"
        raise EngineFailedError(Failure("model_missing", message)) from error
    return str(path)


def network_card(model: ResolvedModel, registry: Registry) -> dict[str, Any] | None:
    """Return the card of a network as it was published, which may have come beside the file and not in it.

    Returns
    -------
    dict or None
        None where the published card says nothing that the engine needs: then that in the file holds.
    """
    if model.kind != "autoencoder" or model.name is None:
        return None
    card = registry.resolve(f"{model.name}@{model.version}").card
    if card.patch_resolution is None:
        return None
    return {**card.extra, **card.model_dump(exclude={"extra"}, exclude_defaults=True), "kind": "autoencoder"}


def deprecation(model: ResolvedModel, registry: Registry) -> Deprecation | None:
    """Return the deprecation of the version, None where there is none; raise ModelNotFoundError."""
    if model.name is None or model.version is None:
        return None
    return registry.resolve(f"{model.name}@{model.version}").deprecated


def _fetch(store: ObjectStore, key: str, sha256: str, path: Path) -> None:
    """Copy an object into the cache: verified first, then visible under its name at once."""
    path.parent.mkdir(parents=True, exist_ok=True)
    digest = hashlib.sha256()
    descriptor, partial = tempfile.mkstemp(dir=path.parent, prefix="fetching-")
    try:
        with os.fdopen(descriptor, "wb") as file, store.local_file(key) as source, source.open("rb") as stored:
            while chunk := stored.read(CHUNK_BYTES):
                digest.update(chunk)
                file.write(chunk)
        if digest.hexdigest() != sha256:
            raise EngineFailedError(Failure("model_damaged", "the model's bytes in the store are not those published"))
        Path(partial).replace(path)
    finally:
        Path(partial).unlink(missing_ok=True)
