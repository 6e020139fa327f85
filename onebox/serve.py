"""`python -m onebox serve`: run a local stack until Ctrl-C or SIGTERM."""

import signal
from collections.abc import Callable

from onebox.local_stack import ADDRESS_FILE, LocalStack, owned_folder, programs
from onebox.processes import Supervisor

STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def serve(stack: LocalStack, say: Callable[[str], None]) -> None:
    """Start the processes of a local stack, keep them running, stop them.

    Parameters
    ----------
    stack : LocalStack
    say : callable
        Gets lines for the person at the terminal.

    Raises
    ------
    StartError
        If the local stack does not come up; whatever was started is stopped again.
    """
    with owned_folder(stack.data):
        address = stack.data / ADDRESS_FILE
        supervisor = Supervisor(programs(stack), stack.log_folder, say)
        for number in STOP_SIGNALS:
            signal.signal(number, supervisor.request_stop)
        try:
            address.unlink(missing_ok=True)
            supervisor.start()
            if supervisor.is_stopping:
                say("stopped before it was ready")
                return
            address.write_text(stack.url, encoding="ascii")
            say(f"Quadpatch is ready on {stack.url} with {stack.n_workers} workers")
            say(f"data in {stack.data}, logs in {stack.log_folder}; stop with Ctrl-C")
            supervisor.watch()
            say("stopping")
        finally:
            address.unlink(missing_ok=True)
            supervisor.stop()
