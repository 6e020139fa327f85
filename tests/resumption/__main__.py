"""`python -m tests.resumption`, or `make resumption`: large uploads while the server is killed and the line is cut.

Each client sends a file through a proxy that cuts the connection at random; the server is killed in the middle of what
a client sends. Afterwards the service must have exactly these bytes, once. Then one upload of some GiB must not make
the service grow. tus-js-client takes part where `--node-modules` names the folder that npm installed it into.
"""

import argparse
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.resumption.campaign import MIB, Trial, memory_growth, run_trial, running_service
from tests.resumption.clients import mesh_of, send_by_sdk, send_by_tus_js, send_by_tuspy
from tests.servers import fresh_bucket, running_s3

# Uploads do not need the queue.
_VARIABLES = {"QUADPATCH_REDIS_URL": "redis://127.0.0.1:1/0", "QUADPATCH_MAX_UPLOAD_MB": "8192"}
_MOST_GROWTH_MIB = 32
_PREFIX = "quadpatch-resumption-"


def main(arguments: list[str]) -> int:
    """Run one campaign; returns the exit code."""
    parser = argparse.ArgumentParser(prog="make resumption ARGS=...", description=__doc__)
    parser.add_argument("--megabytes", type=int, default=200, help="MiB of the file; default 200")
    parser.add_argument("--kills", type=int, default=20, help="of the server, in each upload; default 20")
    parser.add_argument("--cuts", type=int, default=20, help="of the connection, in each upload; default 20")
    parser.add_argument("--seed", type=int, default=1, help="of all chance; default 1")
    parser.add_argument("--store", choices=("local", "s3"), action="append", help="default: both")
    parser.add_argument("--client", action="append", help="default: all that there are")
    parser.add_argument("--node-modules", type=Path, help="folder of tus-js-client; default: it takes no part")
    parser.add_argument("--memory", type=int, default=2048, help="MiB of the upload that is measured; 0: none")
    chosen = parser.parse_args(arguments)
    senders = _senders(chosen.node_modules)
    is_kept = True
    for store in chosen.store or ("local", "s3"):
        for name in chosen.client if chosen.client is not None else senders:
            trial = Trial(chosen.megabytes, chosen.kills, chosen.cuts, chosen.seed)
            with tempfile.TemporaryDirectory(prefix=_PREFIX) as folder, _variables(store) as variables:
                counts = run_trial(trial, Path(folder), variables, senders[name])
            _say(f"{store}, {name}: {chosen.megabytes} MiB arrived whole; {counts}")
        if chosen.memory:
            is_kept = _measure(store, chosen.memory) and is_kept
    return 0 if is_kept else 1


def _senders(modules: Path | None) -> dict[str, Callable[[str, Path], str]]:
    def by(send: Callable[..., str], *rest: object) -> Callable[[str, Path], str]:
        return lambda url, path: mesh_of(url, send(url, path, *rest))

    senders: dict[str, Callable[[str, Path], str]] = {
        "tuspy": by(send_by_tuspy, 32 * MIB),
        "tuspy, checksums": by(send_by_tuspy, 4 * MIB, True),
        "sdk": send_by_sdk,
    }
    if modules is not None:
        senders["tus-js-client"] = by(send_by_tus_js, 0, modules)
        senders["tus-js-client, 4 parallel"] = by(send_by_tus_js, 0, modules, 4)
    return senders


@contextmanager
def _variables(store: str) -> Iterator[dict[str, str]]:
    """Give the settings of a service with an empty store."""
    if store == "local":
        yield _VARIABLES
        return
    with running_s3() as server, fresh_bucket(server) as bucket:
        os.environ.update(server.variables)
        yield {**_VARIABLES, "QUADPATCH_OBJECT_STORE_URL": f"s3://{bucket}/a/prefix"}


def _measure(store: str, n_mib: int) -> bool:
    with (
        tempfile.TemporaryDirectory(prefix=_PREFIX) as folder,
        _variables(store) as variables,
        running_service(Path(folder), variables) as service,
    ):
        growth_mib = memory_growth(service, n_mib) / MIB
    _say(f"{store}: the service grew by {growth_mib:.1f} MiB during an upload of {n_mib} MiB")
    return growth_mib < _MOST_GROWTH_MIB


def _say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
