"""A faster start of numpy and scipy.

scipy takes over every public name of numpy when it is loaded, submodules included, and so loads two that no repair
uses: `numpy.f2py`, a compiler of Fortran, and `numpy.testing`. They are a quarter of the time that scipy takes to load,
and that is most of what a small mesh costs. Here they become modules that are loaded when something in them is asked
for, by the means that the standard library has for it; apart from that nothing changes.

The BLAS of numpy gets one thread. More of them wait for each other in loops, for 0.2 s of CPU time before anything is
computed, and are no faster on matrices as small as a repair has.

Tested in `tests/quadpatch/cli/test_start.py`.
"""

import importlib
import os
import sys
from importlib.util import LazyLoader, find_spec, module_from_spec

from shared_rules.garbage_collection import collect_seldom

_PARENT, _UNUSED = "numpy", ("f2py", "testing")


def prepare_libraries() -> None:
    """Put off what scipy would load and not use, limit the BLAS, and collect garbage less often.

    For a process that does one thing and ends; call it before the first import of numpy.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    collect_seldom()
    parent = importlib.import_module(_PARENT)
    for child in _UNUSED:
        name = f"{_PARENT}.{child}"
        spec = None if name in sys.modules else find_spec(name)
        if spec is None or spec.loader is None:
            continue
        spec.loader = LazyLoader(spec.loader)
        module = module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
        # Else numpy looks for it by an import, which counts as asking for something.
        setattr(parent, child, module)
