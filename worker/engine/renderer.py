"""The renderer of PDFs, confined: `python -m worker.engine.renderer FOLDER PROGRAM [ARGUMENT ...]`.

The page that it prints quotes names and labels of clients, and it is a large program. It reaches the folder, itself and
the libraries and fonts of the system, no network, no other file and no other process.

Tested in `tests/worker/test_pdf.py`.
"""

import os
import resource
import sys
from pathlib import Path

from worker.engine.landlock import restrict_files
from worker.engine.seccomp import restrict_calls_of_a_browser

MOST_PDF_MB = 64
_MOST_CPU_S = 240
_SYSTEM = (
    "/usr",
    "/bin",
    "/lib",
    "/lib64",
    "/etc/alternatives",
    "/etc/chromium",
    "/etc/chromium.d",
    "/etc/fonts",
    "/etc/ld.so.cache",
    "/etc/localtime",
    "/etc/nsswitch.conf",
    "/etc/passwd",
    "/proc/self",
    "/proc/cpuinfo",
    "/proc/meminfo",
    "/proc/stat",
    "/sys/devices",
    "/dev/urandom",
    "/dev/random",
    "/dev/zero",
)


def main(folder: str, program: str, *arguments: str) -> None:
    """Confine this process and become the renderer."""
    for kind, most in (
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_FSIZE, MOST_PDF_MB << 20),
        (resource.RLIMIT_CPU, _MOST_CPU_S),
    ):
        resource.setrlimit(kind, (most, most))
    os.nice(5)
    readable = [*_SYSTEM, str(Path(program).resolve().parent)]
    restrict_files(map(Path, readable), [Path(folder), Path("/dev/null")])
    restrict_calls_of_a_browser()
    os.execv(program, [program, *arguments])


if __name__ == "__main__":
    main(*sys.argv[1:])
