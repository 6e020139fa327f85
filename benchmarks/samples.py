"""The samples of README.md and docs/api.md, made by a real local stack: `make samples`.

A sample is the block of code behind a line `<!-- sample: NAME -->`. This repairs the scan of the demo over HTTP,
shortens the answers, writes the blocks anew, and keeps what it wrote in `docs/samples.json`. Tests hold documents and
contract to that file.

Tested in `tests/attacks/test_k_documents.py`.
"""

import json
import re
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import httpx

from onebox.demo import find_scan, running_stack

ROOT = Path(__file__).resolve().parent.parent
DOCUMENTS = (ROOT / "README.md", ROOT / "docs" / "api.md")
RECORD = ROOT / "docs" / "samples.json"
BLOCK = re.compile(r"(<!-- sample: (?P<name>[\w-]+) -->\n```\n)(?P<text>.*?)(\n```\n)", re.DOTALL)
ELLIPSIS = "…"
_WIDTH = 118
_WAIT = {"Prefer": "wait=30"}
_README_URL = "http://127.0.0.1:8000"


def main() -> int:
    """Write all samples; return the exit code."""
    with tempfile.TemporaryDirectory() as folder, running_stack(Path(folder)) as url:
        samples = record(url, find_scan().read_bytes())
    RECORD.write_text(json.dumps(samples, indent=1, ensure_ascii=False) + "\n", "utf-8")
    for path in DOCUMENTS:
        path.write_text(BLOCK.sub(lambda m: m[1] + samples[m["name"]] + m[4], path.read_text("utf-8")), "utf-8")
    return 0


def record(url: str, scan: bytes) -> dict[str, str]:
    """Return the text of every sample, by its name."""
    with httpx.Client(base_url=url, timeout=600.0) as http:
        uploaded = http.post("/v1/meshes", params={"filename": "scan.ply"}, content=scan, headers=_RAW).json()
        mesh = uploaded
        while mesh["state"] == "analysing":
            mesh = http.get(f"/v1/meshes/{uploaded['id']}", params={"wait": "10"}).json()
        spec = {
            "mesh_id": mesh["id"],
            "method": {"method": "auto", "effort": "standard"},
            "holes": {"max_diameter": 25.0},
            "label": "station 4, part 1187",
        }
        accepted = http.post("/v1/jobs", json=spec).json()
        followed = _wait_for_end(http, accepted["id"])
        repair = http.post("/v1/repairs", files={"mesh": ("scan.ply", scan)}).json()
        repaired = _wait_for_end(http, repair["id"])
        report = http.get(f"/v1/jobs/{repair['id']}/report").json()
    job = ("id", "state", "percent")
    return {
        "start": f"$ curl -F mesh=@scan.ply {_README_URL}/v1/repairs\n{line(repair, job)}",
        "wait": f"$ curl -H 'Prefer: wait=30' {_README_URL}/v1/jobs/$JOB\n"
        + lines(repaired, (*job, "result"), _RESULT),
        "report": f"$ curl {_README_URL}/v1/jobs/$JOB/report\n" + lines(report, ("schema", "counts", "holes"), _REPORT),
        "upload": "$ curl --data-binary @scan.ply -H 'Content-Type: application/octet-stream' "
        f'"$URL/v1/meshes?filename=scan.ply"\n{line(uploaded, ("id", "state", "filename", "format", "size_bytes"))}',
        "mesh": '$ curl "$URL/v1/meshes/$MESH?wait=10"\n' + lines(mesh, ("id", "state", "facts", "problem"), _FACTS),
        "follow": "$ curl -H 'Prefer: wait=30' $URL/v1/jobs/$JOB\n"
        + lines(followed, ("id", "state", "attempt", "max_attempts", "percent", "result", "error", "links"), _RESULT),
    }


def _wait_for_end(http: httpx.Client, job_id: str) -> dict[str, Any]:
    while True:
        job: dict[str, Any] = http.get(f"/v1/jobs/{job_id}", headers=_WAIT).json()
        if job["finished_at"] is not None:
            return job


_RAW = {"Content-Type": "application/octet-stream"}
# What is shown of the objects inside an answer.
_RESULT = {
    "result": ("format", "holes", "new_vertices", "new_triangles", "seconds"),
    "links": ("self", "result"),
}
_REPORT = {"holes": ("id", "diameter", "verdict", "code", "reason", "confidence", "expected_error")}
_FACTS = {
    "facts": ("format", "unit", "vertices", "triangles", "diagonal", "mean_edge_length", "holes"),
    "holes": ("id", "perimeter", "diameter", "edges", "kind"),
}


def line(answer: Mapping[str, Any], keys: tuple[str, ...]) -> str:
    """Write some of an answer in one line."""
    return "{" + ",".join([*(f'"{key}":{_compact(answer[key])}' for key in keys), f" {ELLIPSIS}"]) + "}"


def lines(answer: Mapping[str, Any], keys: tuple[str, ...], inner: Mapping[str, tuple[str, ...]]) -> str:
    """Write some of an answer, broken between its parts; of a list only the first entry."""
    parts = [f'"{key}":{_abridged(key, answer[key], inner)}' for key in keys]
    return wrapped("{" + ",".join([*parts, f" {ELLIPSIS}"]) + "}")


def wrapped(text: str) -> str:
    """Break a long line after commas that end a member."""
    written = []
    while len(text) > _WIDTH:
        place = max(text.rfind(',"', 1, _WIDTH), text.rfind(f", {ELLIPSIS}", 1, _WIDTH))
        if place <= 0:
            break
        written.append(text[: place + 1])
        text = " " + text[place + 1 :].lstrip()
    return "\n".join([*written, text])


def _abridged(key: str, value: Any, inner: Mapping[str, tuple[str, ...]]) -> str:
    if isinstance(value, list) and key in inner:
        return f"[{_abridged(key, value[0], inner)}, {ELLIPSIS}]" if value else "[]"
    if not isinstance(value, dict) or key not in inner:
        return _compact(value)
    return (
        "{" + ",".join(f'"{k}":{_abridged(k, value[k], _deeper(inner, key))}' for k in inner[key]) + f", {ELLIPSIS}}}"
    )


def _deeper(inner: Mapping[str, tuple[str, ...]], key: str) -> dict[str, tuple[str, ...]]:
    """Return what is shown of objects below one; `holes` of a result are counts, not a list."""
    return {} if key == "result" else {name: keys for name, keys in inner.items() if name != key}


def _compact(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"), ensure_ascii=False)


if __name__ == "__main__":
    sys.exit(main())
