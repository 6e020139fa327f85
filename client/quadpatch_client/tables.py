"""Tables for people, on stdout."""

from collections.abc import Iterable
from datetime import UTC
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table

if TYPE_CHECKING:
    from quadpatch_client.schema import Job, MeshFacts, ModelList, ModelVersion, Plan, PlannedBridge, PlannedHole


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
    for name in ("model", "kind", "patch", "size", "aliases", "state", "description"):
        table.add_column(name, overflow="fold")
    for version in (version for model in models.models for version in model.versions):
        resolution = version.card.patch_resolution
        table.add_row(
            f"{version.name}@{version.version}",
            version.kind,
            f"{resolution} × {resolution}" if resolution else "",
            f"{version.size_bytes / 1e6:.1f} MB",
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
    for name in ("job", "task", "state", "done", "created (UTC)"):
        table.add_column(name, no_wrap=True)
    table.add_column("label", overflow="fold")
    for job in jobs:
        detail = job.error.code if job.error else job.stage
        table.add_row(
            job.id,
            job.spec.task,
            f"{job.state.value}: {detail}" if detail else job.state.value,
            f"{job.percent:.0f} %",
            f"{job.created_at.astimezone(UTC):%m-%d %H:%M:%S}",
            job.spec.label or "",
        )
    console.print(table if table.row_count else "no jobs")


def _table(title: str | None) -> Table:
    return Table(title=title, title_justify="left", title_style="", box=None, header_style="bold", pad_edge=False)
