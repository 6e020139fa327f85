"""The engine as it is, until it draws or proves: then native code takes it down, as embree might."""

import ctypes

from worker import engine


def _die(*_: object) -> None:
    ctypes.string_at(0)


engine.add_picture = _die  # type: ignore[assignment]
engine.prove_model = _die  # type: ignore[assignment]
engine.add_close_up_archive = _die  # type: ignore[assignment]
run_request = engine.run_request
