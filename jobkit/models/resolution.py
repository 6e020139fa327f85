"""Which model a job's method means, checked before the job is accepted."""

from jobkit.errors import ModelKindError, NoNetworkError
from jobkit.models.registry import Registry
from quadpatch_client.schema import (
    DEFAULT_MODEL,
    DEFAULT_NETWORK,
    DEFAULT_PAPER_MODEL,
    DEFAULT_PAPER_NETWORK,
    SELF,
    AutoMethod,
    CnnMethod,
    DictionaryMethod,
    EncodedFacts,
    Fitting,
    Method,
    ModelKind,
    ModelVersion,
    Recipe,
    ResolvedModel,
    SmoothMethod,
)

# What cards of dictionaries that were learned for the recipe `paper` say of their normalisation.
PAPER_NORMALISATION = "heights"
_OF_THE_PAPER = {DEFAULT_MODEL: DEFAULT_PAPER_MODEL, DEFAULT_NETWORK: DEFAULT_PAPER_NETWORK}


def resolve_method(registry: Registry, method: Method) -> ResolvedModel:
    """Pin the method's model to the version that its reference means now.

    Raises
    ------
    ModelNotFoundError
        If the reference means nothing.
    ModelKindError
        If it means a model of the other kind, one learned for another recipe than the method's, or one that is taken
        as it is while the method says how long to fit it.
    ModelNotProvenError, ModelRefusedError
        If the version is not to be used.
    NoNetworkError
        If a network is asked for while none is registered.
    """
    if isinstance(method, SmoothMethod):
        return ResolvedModel(requested=method.method, kind="none")
    if isinstance(method, AutoMethod):
        return ResolvedModel(requested=method.method, kind="auto")
    if method.model == SELF:
        return ResolvedModel(requested=SELF, kind="self_network" if isinstance(method, CnnMethod) else "self")
    if isinstance(method, CnnMethod):
        if not registry.has_kind("autoencoder"):
            raise NoNetworkError(
                "no network is registered; upload one with POST /v1/models/{name}/versions, "
                "or use the method 'dictionary' or 'smooth'"
            )
        network = _of_kind(registry, _reference(method), "autoencoder")
        _check_network_recipe(network, method.recipe)
        if method.fitting != Fitting():
            raise ModelKindError(
                f"{network.name}@{network.version} is taken as it is; fitting goes with the model {SELF} only"
            )
        return _pinned(method.model, network)
    version = _of_kind(registry, _reference(method), "dictionary")
    _check_recipe(version, method.recipe)
    return _pinned(method.model, version)


def _reference(method: DictionaryMethod | CnnMethod) -> str:
    """Return the reference of a method's model: with the recipe `paper`, the defaults are others."""
    return _OF_THE_PAPER.get(method.model, method.model) if method.recipe == "paper" else method.model


def resolve_decoding(registry: Registry, method: DictionaryMethod, encoded: EncodedFacts) -> ResolvedModel:
    """Pin the dictionary that a `.qpz` file was encoded with.

    Raises
    ------
    ModelNotFoundError
        If the file names a dictionary that is not registered here.
    ModelKindError
        If the method names another one.
    ModelNotProvenError, ModelRefusedError
        If the version is not to be used.
    """
    if encoded.model_sha256 is None:
        return ResolvedModel(requested=method.model, kind="self")
    if method.model == SELF:
        return _pinned(SELF, registry.with_sha256(encoded.model_sha256, str(encoded.model)))
    named = _of_kind(registry, method.model, "dictionary")
    if named.sha256 != encoded.model_sha256:
        raise ModelKindError(
            f"the file was encoded with {encoded.model}; {named.name}@{named.version} is another dictionary"
        )
    return _pinned(method.model, named)


def _of_kind(registry: Registry, reference: str, kind: ModelKind) -> ModelVersion:
    version = registry.usable(reference)
    if version.kind != kind:
        raise ModelKindError(
            f"{version.name}@{version.version} is of kind {version.kind}; this method needs kind {kind}"
        )
    return version


def learned_for(version: ModelVersion) -> Recipe:
    """Return the recipe that a model was learned for, by its card."""
    card = version.card
    is_paper = card.extra.get("recipe") == "paper" or card.normalisation == PAPER_NORMALISATION
    return "paper" if is_paper else "default"


def _check_recipe(version: ModelVersion, recipe: Recipe) -> None:
    of_model = learned_for(version)
    if of_model != recipe:
        raise ModelKindError(
            f"{version.name}@{version.version} was learned for the recipe {of_model}, not for {recipe}: "
            f"ask for the recipe {of_model}, or take the model self"
        )


def _check_network_recipe(version: ModelVersion, recipe: Recipe) -> None:
    """Refuse other networks than the paper's for its recipe; those go with either recipe."""
    if recipe == "paper" and learned_for(version) != recipe:
        raise ModelKindError(
            f"{version.name}@{version.version} corrects a faired fill, and the recipe paper has none: "
            "leave the recipe out, or take one of the paper's networks"
        )


def _pinned(reference: str, version: ModelVersion) -> ResolvedModel:
    deprecated = version.deprecated
    return ResolvedModel(
        requested=reference,
        kind=version.kind,
        name=version.name,
        version=version.version,
        sha256=version.sha256,
        deprecated_at=None if deprecated is None else deprecated.at,
    )
