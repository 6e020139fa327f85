"""What can go wrong before a local stack is ready.

::

    OneBoxError
    ├── StartError        a process could not be started, or never answered
    └── DemoError         the demo ran, and did not work
"""


class OneBoxError(Exception):
    """Base of all errors of the launcher; its message is meant for the person at the terminal."""


class StartError(OneBoxError):
    """A process could not be started, or never answered."""


class DemoError(OneBoxError):
    """The demo ran, and did not work."""
