"""`python -m onebox serve`: run one box until Ctrl-C or SIGTERM."""

import signal
from collections.abc import Callable

from onebox.box import ADDRESS_FILE, Box, owned_folder, programs
from onebox.processes import Supervisor

_STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def serve(box: Box, say: Callable[[str], None]) -> None:
    """Start the processes of a box, keep them running, stop them.

    Parameters
    ----------
    box : Box
    say : callable
        Gets lines for the person at the terminal.

    Raises
    ------
    StartError
        If the box does not come up; whatever was started is stopped again.
    """
    with owned_folder(box.data):
        address = box.data / ADDRESS_FILE
        supervisor = Supervisor(programs(box), box.log_folder, say)
        for number in _STOP_SIGNALS:
            signal.signal(number, supervisor.request_stop)
        try:
            address.unlink(missing_ok=True)
            supervisor.start()
            if supervisor.is_stopping:
                say("stopped before it was ready")
                return
            address.write_text(box.url, encoding="ascii")
            say(f"Quadpatch is ready on {box.url} with {box.n_workers} workers")
            say(f"data in {box.data}, logs in {box.log_folder}; stop with Ctrl-C")
            supervisor.watch()
            say("stopping")
        finally:
            address.unlink(missing_ok=True)
            supervisor.stop()
