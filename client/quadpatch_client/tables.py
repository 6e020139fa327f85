"""Tables for people, on stdout."""

from collections.abc import Iterable, Sequence
from datetime import UTC
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table

from quadpatch_rules.tasks import FILL

if TYPE_CHECKING:
    from quadpatch_client.schema import (
        Job,
        Key,
        MeshFacts,
        ModelList,
        ModelVersion,
        Plan,
        PlannedBridge,
        PlannedHole,
        Rule,
    )


def print_holes(console: Console, facts: "MeshFacts", plan: "Plan") -> None:
    """Print every hole of a mesh, and whether a job would fill it."""
    unit = facts.unit or "mesh units"
    counts = f"{facts.vertices or 0:,} vertices, {facts.triangles or 0:,} triangles, {len(plan.holes):,} holes"
    table = _table(f"{counts}; lengths in {unit}")
    for name in ("id", "diameter", "perimeter", "edges", "area"):
        table.add_column(name, justify="right")
    for name in ("kind", "centre"):
        table.add_column(name)
    table.add_column("would be filled")
    for hole in plan.holes:
        numbers = (hole.diameter, hole.perimeter)
        table.add_row(
            str(hole.id),
            *(f"{number:.4g}" for number in numbers),
            str(hole.edges),
            f"{hole.area:.4g}",
            hole.kind,
            " ".join(f"{coordinate:.4g}" for coordinate in hole.centre or ()),
            _fate(hole),
        )
    console.print(table)
    console.print(f"{plan.selected:,} of {len(plan.holes):,} would be filled")
    for bridge in plan.bridges:
        console.print(_bridge(bridge, unit))


def _fate(hole: "PlannedHole") -> str:
    if hole.bridged_to is not None:
        return f"yes: bridge to loop {hole.bridged_to}"
    if hole.joined_to is not None:
        return f"yes: joined to hole {hole.joined_to}"
    return f"yes: {hole.action}" if hole.selected else f"no: {(hole.reason or 'by rule').replace('_', ' ')}"


def _bridge(bridge: "PlannedBridge", unit: str) -> str:
    """Say of two loops whether they face each other and whether they would be joined."""
    first, second = bridge.holes
    apart = "" if bridge.gap is None else f", {bridge.gap:.4g} {unit} apart"
    facing = f"loops {first} and {second}" + (f" face each other{apart}" if bridge.is_proposed else "")
    if bridge.selected:
        return f"{facing}: they would be joined"
    return f"{facing}: not joined" + ("" if not bridge.is_proposed else f"; --bridge {first}:{second} joins them")


def print_models(console: Console, models: "ModelList") -> None:
    """Print every version of every model."""
    table = _table(None)
    table.add_column("model", no_wrap=True)
    for name in ("kind", "aliases", "state", "description"):
        table.add_column(name, overflow="fold")
    for version in (version for model in models.models for version in model.versions):
        resolution = version.card.patch_resolution
        table.add_row(
            f"{version.name}@{version.version}",
            f"{version.kind}, {resolution} × {resolution}" if resolution else version.kind,
            ", ".join(version.aliases),
            _standing(version),
            version.card.description,
        )
    console.print(table if table.row_count else "no models")


def _standing(version: "ModelVersion") -> str:
    """Say whether a version may be used, and why not."""
    if version.problem is not None:
        return f"{version.state}: {version.problem.message}"
    return "deprecated" if version.deprecated is not None else str(version.state)


def print_jobs(console: Console, jobs: Iterable["Job"]) -> None:
    """Print jobs, one a line."""
    table = _table(None)
    table.collapse_padding = True  # ids and states are long
    table.add_column("job", no_wrap=True)
    table.add_column("state", no_wrap=True)
    table.add_column("made (UTC)", no_wrap=True)
    table.add_column("label", overflow="fold")
    for job in jobs:
        task = "" if job.spec.task == FILL else f"{job.spec.task}, "
        made = f"{job.created_at.astimezone(UTC):%m-%d %H:%M}"
        table.add_row(job.id, f"{task}{_progress(job)}", made, job.spec.label or "")
    console.print(table if table.row_count else "no jobs")


def _progress(job: "Job") -> str:
    if job.error is not None:
        return f"{job.state.value}: {job.error.code}"
    is_at_work = job.stage is not None and not job.state.is_terminal
    return f"{job.state.value}: {job.stage} {job.percent:.0f} %" if is_at_work else job.state.value


def _table(title: str | None) -> Table:
    return Table(title=title, title_justify="left", title_style="", box=None, header_style="bold", pad_edge=False)


def print_rules(console: Console, rules: "Sequence[Rule]") -> None:
    """Print every rule in its latest version."""
    table = _table(None)
    for name in ("rule", "method", "holes", "description"):
        table.add_column(name, overflow="fold")
    for rule in rules:
        chosen = rule.content.holes.model_dump(mode="json", exclude_defaults=True)
        holes = ", ".join(f"{name.replace('_', ' ')} {_short(value)}" for name, value in chosen.items())
        name = f"{rule.name}@{rule.version}"
        table.add_row(name, rule.content.method.method, holes or "the usual ones", rule.content.description)
    console.print(table if table.row_count else "no rules")


def print_keys(console: Console, keys: "Sequence[Key]") -> None:
    """Print keys, without secrets."""
    table = _table(None)
    for name in ("key", "name", "tenant", "scopes", "last used (UTC)", "state"):
        table.add_column(name, overflow="fold")
    for key in keys:
        used = "never" if key.used_at is None else f"{key.used_at.astimezone(UTC):%Y-%m-%d %H:%M}"
        ends = "" if key.expires_at is None else f"until {key.expires_at.astimezone(UTC):%Y-%m-%d}"
        state = "revoked" if key.revoked_at is not None else ends or "valid"
        table.add_row(key.id, key.name, key.tenant, ", ".join(key.scopes), used, state)
    console.print(table if table.row_count else "no keys")


def _short(value: object) -> str:
    return f"{len(value)} given" if isinstance(value, list) else str(value)
