"""`reconstruct` codes the patches of a whole scan and rebuilds every vertex from them.

Tested in `tests/quadpatch/cli/test_tasks.py`.
"""

from typing import TYPE_CHECKING, Any

from quadpatch.cli.flags import (
    Atoms,
    Model,
    Nonzero,
    Output,
    Overlap,
    Overwrite,
    PatchLength,
    PatchPreset,
    Preview,
    Quiet,
    Report,
    Resolution,
    Seed,
    Source,
)
from quadpatch.cli.tasks import Files, given, run_task, vertices
from quadpatch.progress import Progress

if TYPE_CHECKING:
    from quadpatch.tasks.result import TaskResult


def reconstruct(  # noqa: PLR0913, PLR0917  one argument per flag
    source: Source,
    output: Output,
    model: Model = "self",
    report: Report = None,
    preview: Preview = None,
    overwrite: Overwrite = False,
    patch_length: PatchLength = None,
    resolution: Resolution = None,
    overlap: Overlap = None,
    preset: PatchPreset = None,
    atoms: Atoms = None,
    nonzero: Nonzero = None,
    seed: Seed = 0,
    quiet: Quiet = False,
) -> None:
    """Rebuild a scan from the codes of its patches: what a dictionary can say of it."""

    def task(progress: Progress) -> "TaskResult":
        from quadpatch.reconstruction.whole_surface import ReconstructOptions  # noqa: PLC0415  slow to load
        from quadpatch.tasks.reconstruct import reconstruct_file  # noqa: PLC0415

        patches = {"length": patch_length, "resolution": resolution, "overlap": overlap, "preset": preset}
        values = given(patches=patches, dictionary={"atoms": atoms, "nonzero": nonzero}, seed=seed)
        return reconstruct_file(source, output, model, ReconstructOptions.from_dict(values), progress)

    run_task(Files(source, output, report, preview, overwrite), task, reconstructed, quiet)


def reconstructed(report: dict[str, Any], unit: str) -> str:
    """Say how far the rebuilt vertices are from the scan."""
    patches, dictionary, errors = report["patches"], report["dictionary"], report["error"]
    text = f"{vertices(report['vertices']['rebuilt'])} rebuilt from {patches['count']:,} patches with "
    text += f"{dictionary['nonzero']} of {dictionary['atoms']} atoms each, off by {errors['rms']:.3g} {unit} (RMS)"
    return f"{text}, {errors['max']:.3g} at most; {report['psnr']:.1f} dB"
