"""Landlock: which files this process, and all it starts, may still reach (`man 7 landlock`).

A rule holds for a folder with all below it. What was open before stays open. On a kernel without Landlock nothing
happens; newer kernels forbid more: truncating, devices, signals to processes outside.

Tested in `tests/attacks/test_f_engine.py`.
"""

import ctypes
import os
import sys
from collections.abc import Iterable
from pathlib import Path

_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446
_VERSION_FLAG, _PATH_BENEATH = 1, 1
_PR_SET_NO_NEW_PRIVS = 38

# Rights on files, as bits: 0 execute, 1 write, 2 read, 3 list; 4 to 12 remove and make; 13 link across folders (version
# 2), 14 truncate (3), 15 control devices (5).
_EXECUTE, _WRITE, _READ, _LIST, _TRUNCATE = 1 << 0, 1 << 1, 1 << 2, 1 << 3, 1 << 14
_READING = _EXECUTE | _READ | _LIST
# What a rule on a file, in place of a folder, may name.
_ON_FILES = _EXECUTE | _WRITE | _READ | _TRUNCATE | 1 << 15
_N_RIGHTS = {1: 13, 2: 14, 3: 15, 4: 15}
_N_RIGHTS_NOW = 16
# From version 6 on: abstract unix sockets and signals outside.
_SCOPES, _SCOPED_SINCE = 0b11, 6


class _Ruleset(ctypes.Structure):
    _fields_ = (("files", ctypes.c_uint64), ("network", ctypes.c_uint64), ("scopes", ctypes.c_uint64))


class _Rule(ctypes.Structure):
    _pack_ = 1
    _fields_ = (("rights", ctypes.c_uint64), ("folder", ctypes.c_int32))


def landlock_version() -> int:
    """Return the version of the kernel's Landlock; 0 where it has none."""
    if sys.platform != "linux":
        return 0
    return max(0, int(_libc().syscall(_CREATE_RULESET, None, ctypes.c_size_t(0), _VERSION_FLAG)))


def restrict_files(readable: Iterable[Path], writable: Iterable[Path]) -> None:
    """Leave nothing but these files and folders; those that do not exist are skipped.

    Parameters
    ----------
    readable : iterable of Path
    writable : iterable of Path
        Read as well.

    Raises
    ------
    OSError
        If the kernel has Landlock and refuses the rules.
    """
    version = landlock_version()
    if version == 0:
        return
    handled_rights = (1 << _N_RIGHTS.get(version, _N_RIGHTS_NOW)) - 1
    ruleset = _call(_CREATE_RULESET, *_ruleset_attributes(version, handled_rights), 0)
    try:
        for path in readable:
            _allow(ruleset, path, _READING & handled_rights)
        for path in writable:
            _allow(ruleset, path, handled_rights & ~_EXECUTE)
        forbid_new_privileges()
        _call(_RESTRICT_SELF, ruleset, 0)
    finally:
        os.close(ruleset)


def forbid_new_privileges() -> None:
    """Let no program that is run from here on gain rights, as by a set-user-id bit."""
    if sys.platform == "linux" and _libc().prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "new privileges can't be forbidden")


def _ruleset_attributes(version: int, handled_rights: int) -> tuple[ctypes.Array[ctypes.c_char], ctypes.c_size_t]:
    """Describe a ruleset as long as the kernel knows it: an older one refuses fields that it does not know."""
    ruleset = _Ruleset(handled_rights, 0, _SCOPES if version >= _SCOPED_SINCE else 0)
    size = ctypes.sizeof(_Ruleset) if version >= _SCOPED_SINCE else ctypes.sizeof(ctypes.c_uint64)
    return ctypes.create_string_buffer(bytes(ruleset)[:size], size), ctypes.c_size_t(size)


def _allow(ruleset: int, path: Path, rights: int) -> None:
    try:
        descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return
    try:
        file_rights = rights if path.is_dir() else rights & _ON_FILES
        _call(_ADD_RULE, ruleset, _PATH_BENEATH, ctypes.byref(_Rule(file_rights, descriptor)), 0)
    finally:
        os.close(descriptor)


def _call(number: int, *arguments: object) -> int:
    answer = int(_libc().syscall(number, *arguments))
    if answer < 0:
        raise OSError(ctypes.get_errno(), f"landlock refuses call {number}: {os.strerror(ctypes.get_errno())}")
    return answer


def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)
