"""The engine as it is, until it draws or proves: then native code crashes, as embree might."""

import ctypes

from worker.engine import main


def _crash(*_: object, **__: object) -> None:
    ctypes.string_at(0)


for name in ("add_picture", "prove_model", "add_close_up_archive", "add_html_report"):
    assert hasattr(main, name)
    setattr(main, name, _crash)
run_request = main.run_request
