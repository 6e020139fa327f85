"""A faster start of numpy and scipy.

scipy takes over every public name of numpy when it is loaded, submodules included, and so loads two that no repair
uses: `numpy.f2py`, a compiler of Fortran, and `numpy.testing`. They are a quarter of the time that scipy takes to load,
and that is most of what a small mesh costs. Here they become modules that are loaded when something in them is asked
for, by the means that the standard library has for it; apart from that nothing changes.

`scipy.spatial` loads rotations and the distances of other metrics, and with those `scipy.special`, whose docstrings are
put together as it is loaded. A repair uses its trees and hulls alone, so these modules are put off as well.

The BLAS of numpy gets one thread. More of them wait for each other in loops, for 0.2 s of CPU time before anything is
computed, and are no faster on matrices as small as a repair has.

Tested in `tests/quadpatch/cli/test_start.py`.
"""

import importlib
import os
import sys
from functools import partial
from importlib.util import LazyLoader, find_spec, module_from_spec
from types import ModuleType

from quadpatch_rules.garbage_collection import collect_seldom

_PARENT, _UNUSED = "numpy", ("f2py", "testing")
_PUT_OFF = ("scipy.spatial.distance", "scipy.spatial.transform")
# It loads the first of these for one function.
_USER, _FUNCTION = "scipy.spatial._geometric_slerp", "geometric_slerp"


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
    if "scipy.spatial" not in sys.modules:
        for name in _PUT_OFF:
            sys.modules[name] = _PutOff(name)
        user = sys.modules[_USER] = _PutOff(_USER)
        setattr(user, _FUNCTION, partial(_call, user))


def _call(module: ModuleType, *given: object, **named: object) -> object:
    """Call the function that `scipy.spatial` takes from a module as it is loaded."""
    return getattr(_loaded(module), _FUNCTION)(*given, **named)


class _PutOff(ModuleType):
    """A module that loads itself when something in it is asked for.

    `importlib.util.LazyLoader` would load the parent first, which asks for it.
    """

    def __getattr__(self, name: str) -> object:
        # What every import looks at is no use of the module.
        if name.startswith("__") or self.__spec__ is not None:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        return getattr(_loaded(self), name)


def _loaded(module: ModuleType) -> ModuleType:
    """Load what was put off, in its place, unless that is done."""
    if module.__spec__ is None:
        name = module.__name__
        del sys.modules[name]
        spec = find_spec(name)
        sys.modules[name] = module
        if spec is None or spec.loader is None:
            raise ModuleNotFoundError(name, name=name)
        module.__dict__.update(vars(module_from_spec(spec)))
        spec.loader.exec_module(module)
    return module
