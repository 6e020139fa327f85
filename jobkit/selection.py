"""Which model a job's method means, checked before the job is accepted."""

from jobkit.errors import ModelKindError, NoNetworkError
from jobkit.registry import Registry
from jobkit.schema import SELF, CnnMethod, Method, ModelKind, ResolvedModel, SmoothMethod


def resolve_method(registry: Registry, method: Method) -> ResolvedModel:
    """Pin the method's model to the version that its reference means now.

    Raises
    ------
    ModelNotFoundError
        If the reference means nothing.
    ModelKindError
        If it means a model of the other kind.
    NoNetworkError
        If a network is asked for while none is registered.
    """
    if isinstance(method, SmoothMethod):
        return ResolvedModel(requested=method.method, kind="none")
    if isinstance(method, CnnMethod):
        if not registry.has_kind("autoencoder"):
            raise NoNetworkError(
                "no network is registered; upload one with POST /v1/models/{name}/versions, "
                "or use the method 'dictionary' or 'smooth'"
            )
        return _pin(registry, method.model, "autoencoder")
    if method.model == SELF:
        return ResolvedModel(requested=SELF, kind="self")
    return _pin(registry, method.model, "dictionary")


def _pin(registry: Registry, reference: str, kind: ModelKind) -> ResolvedModel:
    version = registry.resolve(reference)
    if version.kind != kind:
        raise ModelKindError(
            f"{version.name}@{version.version} is of kind {version.kind}; this method needs kind {kind}"
        )
    return ResolvedModel(
        requested=reference, kind=kind, name=version.name, version=version.version, sha256=version.sha256
    )
