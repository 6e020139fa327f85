"""Seccomp: which calls of the kernel this process, and all it starts, may still make (`man 2 seccomp`).

A filter is a small program that the kernel runs on every call. This one refuses sockets, new processes, a look into
other processes and signals to them, and what changes the machine. All else, threads among it, goes on as before.

Tested in `tests/attacks/test_f_engine.py`.
"""

import ctypes
import errno
import os
import platform
import socket
import struct
import sys
from dataclasses import dataclass

from worker.engine.landlock import forbid_new_privileges

_PR_GET_SECCOMP, _PR_SET_SECCOMP, _FILTER_MODE = 21, 22, 2
ALLOW, REFUSE, KILL = 0x7FFF0000, 0x00050000, 0x80000000
_CLONE_THREAD = 0x00010000
# Offsets in what the filter sees: number of the call, machine, arguments of eight bytes each (the low half first).
_NUMBER, _MACHINE, _FIRST_ARGUMENT = 0, 4, 16
# Above it lie the calls of the x32 binary interface, which are the same under other numbers.
_X32 = 0x40000000

# Name: number on x86_64, on aarch64; None where there is no such call.
_SOCKETS: dict[str, tuple[int | None, int | None]] = {
    "socket": (41, 198),
    "socketpair": (53, 199),
    "connect": (42, 203),
    "bind": (49, 200),
    "listen": (50, 201),
    "accept": (43, 202),
    "accept4": (288, 242),
    # Opens sockets without the calls above.
    "io_uring_setup": (425, 425),
}
_OTHER_CALLS: dict[str, tuple[int | None, int | None]] = {
    "fork": (57, None),
    "vfork": (58, None),
    "execve": (59, 221),
    "execveat": (322, 281),
    "ptrace": (101, 117),
    "process_vm_readv": (310, 270),
    "process_vm_writev": (311, 271),
    "kcmp": (312, 272),
    "pidfd_open": (434, 434),
    "pidfd_getfd": (438, 438),
    "pidfd_send_signal": (424, 424),
    "rt_sigqueueinfo": (129, 138),
    "tkill": (200, 130),
    "unshare": (272, 97),
    "setns": (308, 268),
    "mount": (165, 40),
    "umount2": (166, 39),
    "pivot_root": (155, 41),
    "chroot": (161, 51),
    "open_tree": (428, 428),
    "move_mount": (429, 429),
    "fsopen": (430, 430),
    "open_by_handle_at": (304, 265),
    "bpf": (321, 280),
    "perf_event_open": (298, 241),
    "userfaultfd": (323, 282),
    "keyctl": (250, 219),
    "add_key": (248, 217),
    "request_key": (249, 218),
    "init_module": (175, 105),
    "finit_module": (313, 273),
    "kexec_load": (246, 104),
    "reboot": (169, 142),
    "swapon": (167, 224),
    "settimeofday": (164, 170),
    "clock_settime": (227, 112),
}
# Of those above.
_CALLS_OF_A_BROWSER = frozenset({"fork", "vfork", "execve", "tkill", "pidfd_open"})


@dataclass(frozen=True)
class _Machine:
    column: int
    audit: int
    clone: int
    clone3: int
    # Calls whose first argument names a process, which has to be this one, or 0.
    about_a_process: tuple[int, ...]


_MACHINES = {
    "x86_64": _Machine(0, 0xC000003E, 56, 435, (62, 234, 302, 297)),  # kill, tgkill, prlimit64, rt_tgsigqueueinfo
    "aarch64": _Machine(1, 0xC00000B7, 220, 435, (129, 131, 261, 240)),
}


class _Program(ctypes.Structure):
    _fields_ = (("length", ctypes.c_ushort), ("instructions", ctypes.c_char_p))


def has_seccomp() -> bool:
    """Tell whether the kernel takes filters, and this module knows the machine."""
    if sys.platform != "linux" or platform.machine() not in _MACHINES:
        return False
    return int(ctypes.CDLL(None).prctl(_PR_GET_SECCOMP, 0, 0, 0, 0)) >= 0


def restrict_calls() -> None:
    """Refuse the calls named above to this process and all it starts; does nothing on a kernel without filters.

    Raises
    ------
    OSError
        If the kernel takes filters and refuses this one.
    """
    if has_seccomp():
        machine = _MACHINES[platform.machine()]
        refused = [*_SOCKETS.values(), *_OTHER_CALLS.values()]
        _install(_filter(machine, _numbers(refused, machine), REFUSE | errno.EPERM, os.getpid()))


def restrict_calls_of_a_browser() -> None:
    """Refuse a browser the network and a look into other processes; it may start programs and talk to itself.

    It may make unix sockets, and connect to none by a name.

    Raises
    ------
    OSError
        If the kernel takes filters and refuses this one.
    """
    if has_seccomp():
        machine = _MACHINES[platform.machine()]
        others = [numbers for name, numbers in _OTHER_CALLS.items() if name not in _CALLS_OF_A_BROWSER]
        refused = _numbers([_SOCKETS["connect"], _SOCKETS["io_uring_setup"], *others], machine)
        answer = REFUSE | errno.EPERM
        lines = [*_head(machine), *(line for number in refused for line in _if_equal(number, answer))]
        (socket_number,) = _numbers([_SOCKETS["socket"]], machine)
        lines += [(0x15, 0, 4, socket_number), _load(_FIRST_ARGUMENT), (0x15, 0, 1, socket.AF_UNIX)]
        lines += [_end(ALLOW), _end(answer)]
        _install(_assembled([*lines, _end(ALLOW)]))


def kill_on_socket() -> None:
    """End this process as soon as it opens a socket, for tests."""
    machine = _MACHINES[platform.machine()]
    _install(_socket_trap(machine, _numbers(list(_SOCKETS.values()), machine)))


def _numbers(calls: list[tuple[int | None, int | None]], machine: _Machine) -> list[int]:
    return [number for call in calls if (number := call[machine.column]) is not None]


def _filter(machine: _Machine, refused: list[int], answer: int, pid: int) -> bytes:
    lines = [*_head(machine), *(line for number in refused for line in _if_equal(number, answer))]
    # Without clone3, whose flags a filter can't see, the C library takes clone.
    lines += _if_equal(machine.clone3, REFUSE | errno.ENOSYS)
    lines += [(0x15, 0, 4, machine.clone), _load(_FIRST_ARGUMENT), (0x45, 0, 1, _CLONE_THREAD), _end(ALLOW)]
    lines += [_end(answer)]
    for number in machine.about_a_process:
        lines += [(0x15, 0, 5, number), _load(_FIRST_ARGUMENT), (0x15, 1, 0, pid), (0x15, 0, 1, 0), _end(ALLOW)]
        lines += [_end(answer)]
    return _assembled([*lines, _end(ALLOW)])


def _socket_trap(machine: _Machine, numbers: list[int]) -> bytes:
    return _assembled([*_head(machine), *(line for number in numbers for line in _if_equal(number, KILL)), _end(ALLOW)])


_Line = tuple[int, int, int, int]


def _head(machine: _Machine) -> list[_Line]:
    """Kill a process that calls the kernel as on another architecture; load the number of the call."""
    return [
        _load(_MACHINE),
        (0x15, 1, 0, machine.audit),
        _end(KILL),
        _load(_NUMBER),
        (0x35, 0, 1, _X32),
        _end(REFUSE | errno.ENOSYS),
    ]


def _load(offset: int) -> _Line:
    return (0x20, 0, 0, offset)


def _end(answer: int) -> _Line:
    return (0x06, 0, 0, answer)


def _if_equal(number: int, answer: int) -> list[_Line]:
    return [(0x15, 0, 1, number), _end(answer)]


def _assembled(lines: list[_Line]) -> bytes:
    return b"".join(struct.pack("=HBBI", *line) for line in lines)


def _install(instructions: bytes) -> None:
    forbid_new_privileges()
    program = _Program(len(instructions) // 8, instructions)
    if ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_SECCOMP, _FILTER_MODE, ctypes.byref(program), 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "the kernel refuses the filter of calls")
