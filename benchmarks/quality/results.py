"""Results that are kept: an experiment that was cut short goes on where it stopped.

One JSON file per result, named by what was measured and with all of that inside, the version of the code included:
after a change of the method, its results are measured again.
"""

import hashlib
import json
import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

REPAIRS, CODINGS, REBUILDINGS = "repairs", "codings", "rebuildings"
MODELS, NETWORKS, PEERS = "models", "networks", "peers"
# What a change of the method makes stale, and what only a change of the paper's recipe or of the peers does.
OF_THE_METHOD = (REPAIRS, CODINGS, REBUILDINGS)
ALL_KINDS = (*OF_THE_METHOD, MODELS, NETWORKS, PEERS)

Key = Mapping[str, str | int | float]


@dataclass
class Results:
    """A folder of results of one version of the code; those of earlier runs don't count for the kinds that are `fresh`.

    Attributes
    ----------
    folder : Path
    fresh : collection of str
    code : str
        Hash of the method's code; results of the peers don't depend on it.
    """

    folder: Path
    fresh: Collection[str] = ()
    code: str = ""
    _made: set[Path] = field(default_factory=set)

    def get(self, kind: str, key: Key, compute: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """Return the result of a key, from its file or computed and put there.

        Parameters
        ----------
        kind : str
            One of `ALL_KINDS`: a folder.
        key : mapping of str to str or number
            Everything that the result depends on, but the code.
        compute : callable
            Gives the result, JSON-ready.
        """
        if kind != PEERS:
            key = {**key, "code_sha256": key.get("code_sha256", self.code)}
        path = self.folder / kind / f"{_name(key)}.json"
        if path.is_file() and (kind not in self.fresh or path in self._made):
            kept: dict[str, Any] = json.loads(path.read_text())
            return dict(kept["result"])
        result = compute()
        path.parent.mkdir(parents=True, exist_ok=True)
        # In one step: a run may be stopped at any moment.
        partial = path.with_suffix(".partial")
        partial.write_text(json.dumps({"key": dict(key), "result": result}, indent=1) + "\n")
        partial.replace(path)
        self._made.add(path)
        return dict(json.loads(path.read_text())["result"])


def _name(key: Key) -> str:
    """Name a file for people, and by a hash for good."""
    words = [str(value) for name, value in key.items() if "sha256" not in name]
    digest = hashlib.sha256(json.dumps(dict(key), sort_keys=True).encode()).hexdigest()[:10]
    return re.sub(r"[^A-Za-z0-9.@=+-]+", "-", "_".join(words))[:100] + "_" + digest
