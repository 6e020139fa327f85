"""``python -m benchmarks.output_hashes FOLDER``: what repairs put out, as hashes.

A change that moves or renames code must leave every bit of a repair as it was. Each mesh of a folder is repaired with
each model; one line per repair goes to standard output: the sha256 of the repaired file, that of its report without
seconds and memory, mesh and model. The output of two runs is compared with ``diff``.
"""

import argparse
import hashlib
import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

_COSTS = ("seconds", "peak_memory_mib")
MODELS = ("smooth", "self", "general-residual@1")


def main(arguments: Sequence[str] | None = None) -> None:
    """Read the command line, repair, and print the hashes."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.output_hashes", description=__doc__)
    parser.add_argument("folder", type=Path, help="folder of meshes with holes")
    parser.add_argument("--model", action="append", help=f"model, may be repeated; by default {', '.join(MODELS)}")
    options = parser.parse_args(arguments)
    scans = sorted(path for path in options.folder.iterdir() if path.suffix in {".ply", ".stl", ".obj", ".off"})
    if not scans:
        sys.exit(f"error: there is no mesh in {options.folder}")
    for scan in scans:
        for model in options.model or MODELS:
            print(*hashes(scan, model), scan.name, model, flush=True)  # noqa: T201


def hashes(scan: Path, model: str) -> tuple[str, str]:
    """Repair one mesh; return the sha256 of the repaired file and of its report.

    Raises
    ------
    subprocess.CalledProcessError
        If the repair fails.
    """
    with tempfile.TemporaryDirectory() as folder:
        repaired, report = Path(folder, "repaired" + scan.suffix), Path(folder, "report.json")
        command = [sys.executable, "-m", "quadpatch", "fill", str(scan), "-o", str(repaired), "--report", str(report)]
        subprocess.run([*command, "--model", model], check=True, capture_output=True)
        comparable = json.dumps(_without_costs(json.loads(report.read_bytes())), sort_keys=True)
        return hashlib.sha256(repaired.read_bytes()).hexdigest(), hashlib.sha256(comparable.encode()).hexdigest()


def _without_costs(value: Any) -> Any:
    """Leave out of a report what differs from run to run."""
    if isinstance(value, dict):
        return {name: _without_costs(item) for name, item in value.items() if name not in _COSTS}
    return [_without_costs(item) for item in value] if isinstance(value, list) else value


if __name__ == "__main__":
    main()
