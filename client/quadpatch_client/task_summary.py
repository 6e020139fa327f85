"""What a task besides filling holes has done, in a sentence.

Tested in `tests/quadpatch_client/test_task_commands.py`.
"""

from collections.abc import Callable, Mapping

from quadpatch_client.schema import JobResult, Task


def task_sentence(name: str, task: Task, result: JobResult, unit: str) -> str:
    """Say what became of a mesh.

    Parameters
    ----------
    name : str
        Of the mesh, for people.
    task : str
        Any but `fill`.
    result : JobResult
    unit : str
        Of lengths.
    """
    return f"{name}: {_SENTENCES.get(task, _done)(result, unit)}."


def counted(number: int, noun: str) -> str:
    """Write a number with its noun."""
    plural = {"vertex": "vertices"}.get(noun, noun + "s")
    return f"{number:,} {noun if number == 1 else plural}"


def _restored(result: JobResult, _unit: str) -> str:
    n_restored = result.restored_vertices
    which = "missing vertices" if n_restored is None else counted(n_restored, "vertex").replace(" ", " missing ", 1)
    return f"{which} got a position; all others kept their bits"


def _denoised(result: JobResult, unit: str) -> str:
    moved = "the vertices were moved" if result.moved_vertices is None else _moved(result.moved_vertices)
    bound = "" if result.shift_95 is None else f", 95 of 100 of them by no more than {result.shift_95:.3g} {unit}"
    return f"{moved}{bound}"


def _moved(n_moved: int) -> str:
    return f"{counted(n_moved, 'vertex')} {'was' if n_moved == 1 else 'were'} moved"


def _encoded(result: JobResult, unit: str) -> str:
    file = result.file("result")
    size = "encoded" if file is None else f"encoded in {file.size_bytes:,} bytes"
    error = "" if result.max_error is None else f", no farther than {result.max_error:.3g} {unit} from the scan"
    return f"{size}{error}"


def _done(_result: JobResult, _unit: str) -> str:
    """Say little of a task that only a newer service knows."""
    return "done"


_SENTENCES: Mapping[str, Callable[[JobResult, str], str]] = {
    "restore": _restored,
    "denoise": _denoised,
    "encode": _encoded,
    "decode": lambda result, _: f"decoded as {result.format}",
}
