"""The command `doctor`.

Tested in `tests/quadpatch_client/test_doctor.py`.
"""

import json
from dataclasses import asdict
from pathlib import Path

import typer
from rich.console import Console
from rich.table import Table

from quadpatch_client.exit_codes import ExitCode
from quadpatch_client.options import DEFAULT_URL, JsonOption, KeyOption, UrlOption

_STYLES = {"ok": "green", "warning": "yellow", "error": "red"}


def doctor(url: UrlOption = DEFAULT_URL, api_key: KeyOption = None, as_json: JsonOption = False) -> None:
    """Look for what is in the way: disk, connection, TLS, versions, clocks, key and limits; say what to do."""
    from quadpatch_client.doctor import examine, exit_is_clean  # noqa: PLC0415  loads HTTP, which --help does without

    findings = list(examine(url, api_key, Path.cwd()))
    if as_json:
        typer.echo(json.dumps([asdict(finding) for finding in findings], indent=2))
    else:
        table = Table(box=None, header_style="bold", pad_edge=False)
        for name in ("what", "verdict", "found"):
            table.add_column(name, overflow="fold", no_wrap=name != "found")
        for finding in findings:
            words = finding.text + (f"\n→ {finding.advice}" if finding.advice else "")
            verdict = f"[{_STYLES[finding.verdict]}]{finding.verdict}[/]"
            table.add_row(finding.subject, verdict, words.replace("[", "\\["))
        Console(highlight=False).print(table)
    if any(finding.subject == "key" and finding.verdict == "error" for finding in findings):
        raise typer.Exit(ExitCode.REJECTED)
    if not exit_is_clean(findings):
        is_reached = any(finding.subject == "service" and finding.verdict != "error" for finding in findings)
        raise typer.Exit(ExitCode.OTHER if is_reached else ExitCode.UNREACHABLE)
