"""Which inpainter a model's name, a shipped model or a model file stands for, and which options go with it.

Each inpainter is imported where it is asked for: geometry alone needs none of them, nor the libraries behind them.

Tested in `tests/quadpatch/test_repair_by_effort.py`.
"""

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from quadpatch.errors import ModelError, OptionError, TorchMissingError
from quadpatch.inpainters.inpainter import Inpainter
from quadpatch.options import DictionaryOptions, NetworkOptions, RepairOptions
from quadpatch.progress import Progress

if TYPE_CHECKING:
    from quadpatch.inpainters.model_file import Model
    from quadpatch.sparse.dictionary import Dictionary

AUTO = "auto"
SMOOTH = "smooth"
SELF = "self"
SELF_NETWORK = "self-network"
# The same, as a job names the kind of its model.
SELF_NETWORK_KIND = "self_network"

_FITTED = (SELF_NETWORK, SELF_NETWORK_KIND)

# The network that is fitted to a mesh where `SELF_NETWORK` is asked for.
BASE_NETWORK = "general-residual"

FITS_NOTHING = (
    f"network.steps and network.seconds go with the model {SELF_NETWORK}, and with the effort best of {AUTO}, only"
)
NOTHING_TO_DO = (
    "the recipe paper is a way to use a learned model; with smooth there is none: drop the recipe or take self"
)


def choose_model(
    model: str | Path | None, options: RepairOptions, progress: Progress, network_card: dict[str, Any] | None
) -> tuple[Inpainter | None, dict[str, Any]]:
    """Turn a model's name or path into its inpainter.

    Parameters
    ----------
    model : str or Path or None
        `auto` (what calibration finds best; `options.effort` says of how much), `smooth` (no learning), `self` (learn
        a dictionary from the mesh itself), `self-network` (fit the shipped network to the mesh itself), the name of a
        shipped model (`name` or `name@version`), or a model file. None stands for `auto`, with the recipe paper for
        `self`.
    options : RepairOptions
    progress : callable
    network_card : dict or None
        Of a network that was published without a card in its file.

    Returns
    -------
    inpainter : Inpainter or None
        None fills by geometry alone.
    facts : dict
        What the report says of the model.

    Raises
    ------
    OptionError
        If the options do not go with the model.
    ModelError
        If there is no such model, or its file is none.
    """
    if model is None:
        model = SELF if options.recipe == "paper" else AUTO
    if model == SMOOTH and options.recipe == "paper":
        raise OptionError(NOTHING_TO_DO)
    if model == AUTO:
        return _automatic(options, progress)
    _check_choice(model, options)
    if model in _FITTED:
        return _network_to_fit(options, progress)
    if model == SMOOTH:
        return None, {"name": SMOOTH}
    if model == SELF:
        return _dictionary_of_the_mesh(options, progress), {"name": SELF}
    loaded, facts = find_model(model)
    if loaded.dictionary is None:
        return _network(loaded.path, options, network_card), facts
    return _dictionary(loaded, loaded.dictionary, options), facts


def _check_choice(model: str | Path, options: RepairOptions) -> None:
    """Refuse options that go with other models."""
    if options.effort != RepairOptions.effort:
        raise OptionError(f"effort goes with the model {AUTO} only")
    if options.network != NetworkOptions() and model not in _FITTED:
        raise OptionError(FITS_NOTHING)


def find_model(model: str | Path) -> tuple["Model", dict[str, Any]]:
    """Read a model file, or the shipped model of a name.

    Returns
    -------
    model : Model
    facts : dict
        What reports say of it: name, version, kind and sha256.

    Raises
    ------
    ModelError
        If there is no such model, or its file is none.
    """
    from quadpatch.inpainters.model_file import load_model, shipped_model  # noqa: PLC0415  see the module docstring

    path = Path(model)
    if not path.is_file():
        path = shipped_model(str(model))
    loaded = load_model(path)
    facts = {"name": loaded.card.get("name", path.stem), "version": loaded.card.get("version"), "kind": loaded.kind}
    return loaded, {**facts, "sha256": sha256_of(path)}


def sha256_of(path: Path) -> str:
    """Hash a file's bytes, in hex."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _automatic(options: RepairOptions, progress: Progress) -> tuple[Inpainter | None, dict[str, Any]]:
    """Choose what competes on the mesh, by the effort: the best of it, their mean or geometry alone fills the holes."""
    if options.recipe == "paper":
        raise OptionError("the recipe paper is a way to use one learned model: name it, or take self")
    if options.effort != "best" and options.network != NetworkOptions():
        raise OptionError(FITS_NOTHING)
    facts: dict[str, Any] = {"name": AUTO, "effort": options.effort}
    if options.effort == "fast":
        return None, facts
    from quadpatch.inpainters.competing import CompetingInpainters  # noqa: PLC0415  see the module docstring

    networks, not_tried = _competing_networks(options, progress)
    if not_tried:
        facts["not_tried"] = not_tried
    return CompetingInpainters({SELF: _dictionary_of_the_mesh(options, progress), **networks}), facts


def _competing_networks(options: RepairOptions, progress: Progress) -> tuple[dict[str, Inpainter], dict[str, str]]:
    """Open the networks that an effort asks for; say of those that can't compete, why."""
    from quadpatch.patches.scale import asked_resolution  # noqa: PLC0415  see the module docstring

    shipped, asked = _network(find_model(BASE_NETWORK)[0].path, options, None), asked_resolution(options.patches)
    if asked is not None and asked != shipped.resolution:
        names = [BASE_NETWORK, SELF_NETWORK] if options.effort == "best" else [BASE_NETWORK]
        return {}, dict.fromkeys(names, f"its patches have {shipped.resolution} bins along a side, not {asked}")
    if options.effort != "best":
        return {BASE_NETWORK: shipped}, {}
    try:
        return {BASE_NETWORK: shipped, SELF_NETWORK: _network_to_fit(options, progress)[0]}, {}
    except TorchMissingError as error:
        return {BASE_NETWORK: shipped}, {SELF_NETWORK: str(error)}


def _dictionary_of_the_mesh(options: RepairOptions, progress: Progress) -> Inpainter:
    """Learn a dictionary from the mesh itself."""
    from quadpatch.inpainters.dictionary import SelfDictionary  # noqa: PLC0415  see the module docstring
    from quadpatch.inpainters.paper_dictionary import SelfHeights  # noqa: PLC0415

    is_paper = options.recipe == "paper"
    return SelfHeights(options.dictionary, options.seed, progress) if is_paper else SelfDictionary()


def _dictionary(loaded: "Model", dictionary: "Dictionary", options: RepairOptions) -> Inpainter:
    """Take a dictionary for the recipe that it was learned for."""
    from quadpatch.inpainters.dictionary import DictionaryInpainter  # noqa: PLC0415  see the module docstring
    from quadpatch.inpainters.paper_dictionary import HeightsInpainter  # noqa: PLC0415

    _check_recipe(loaded, options)
    if loaded.recipe == "paper":
        return HeightsInpainter(dictionary, length_share(loaded))
    return DictionaryInpainter(dictionary)


def length_share(model: "Model") -> float | None:
    """Read how wide the patches were that a dictionary of heights was learned from."""
    share = model.card.get("length_share")
    if share is None:
        return None
    if isinstance(share, bool) or not isinstance(share, int | float) or not 0 < share <= 1:
        raise ModelError(f"{model.path.name}: length_share must lie between 0 and 1; it is {share!r}")
    return float(share)


def _network(path: Path, options: RepairOptions, card: dict[str, Any] | None) -> Inpainter:
    """Open a network. Those of the paper are used by either recipe, others by our own alone."""
    from quadpatch.inpainters.onnx_network import AutoencoderInpainter  # noqa: PLC0415  onnxruntime is slow to load

    network = AutoencoderInpainter.load(path, card)
    if options.recipe == "paper" and network.recipe != "paper":
        raise OptionError(
            f"{path.name} is a network for the recipe {network.recipe}, which corrects a faired fill; "
            "the recipe paper has none: drop it, or take one of the paper's networks"
        )
    if options.dictionary != DictionaryOptions():
        raise OptionError(f"dictionary.atoms and dictionary.nonzero go with the model self; {path.name} is a network")
    return network


def _network_to_fit(options: RepairOptions, progress: Progress) -> tuple[Inpainter, dict[str, Any]]:
    """Open the shipped network for training."""
    if options.recipe == "paper":
        raise OptionError(f"the recipe paper goes with dictionaries; {SELF_NETWORK} has a recipe of its own")
    from quadpatch.inpainters.model_file import shipped_model  # noqa: PLC0415  see the module docstring

    path = shipped_model(BASE_NETWORK)
    try:
        from quadpatch.networks.fitting import FittingInpainter  # noqa: PLC0415  an extra, and slow to load
        from quadpatch.networks.weights import load_residual  # noqa: PLC0415
    except ModuleNotFoundError as error:
        raise TorchMissingError(
            f"fitting a network to a mesh needs {error.name}, which is not installed here: "
            f"install the extra 'networks', or take a model that is ready, such as {BASE_NETWORK}"
        ) from error
    return FittingInpainter(load_residual(path), options.network, options.seed, progress), {
        "name": SELF_NETWORK,
        "fitted_from": path.stem,
    }


def _check_recipe(model: "Model", options: RepairOptions) -> None:
    """Refuse a dictionary that was learned for the other recipe, and a size for one that has a size."""
    name = model.path.name
    if model.recipe != options.recipe:
        raise OptionError(
            f"{name} was learned for the recipe {model.recipe}, not for {options.recipe}: "
            f"ask for the recipe {model.recipe}, or take the model self"
        )
    if options.dictionary != DictionaryOptions():
        raise OptionError(f"dictionary.atoms and dictionary.nonzero go with the model self; {name} has its own")
