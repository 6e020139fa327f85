"""The engine as it is, until it draws or proves: then native code takes it down, as embree might."""

import ctypes

from worker.engine import main


def _die(*_: object) -> None:
    ctypes.string_at(0)


main.add_picture = _die  # type: ignore[assignment]
main.prove_model = _die  # type: ignore[assignment]
main.add_close_up_archive = _die  # type: ignore[assignment]
run_request = main.run_request
