"""The commands of `python -m quadpatch`.

Data goes to standard output, progress and errors to standard error. Exit codes: 0 done, 1 the file, the model or an
option is at fault (`code: message` on standard error), 2 wrong usage.
"""

import typer

from quadpatch.cli.denoise import denoise
from quadpatch.cli.encode import decode, encode
from quadpatch.cli.fill import fill
from quadpatch.cli.holes import holes
from quadpatch.cli.reconstruct import reconstruct
from quadpatch.cli.restore import restore

app = typer.Typer(
    help="Repair holes in 3D scans, and put their patches to other uses.", no_args_is_help=True, add_completion=False
)
for command in (fill, holes, restore, denoise, encode, decode, reconstruct):
    app.command()(command)
