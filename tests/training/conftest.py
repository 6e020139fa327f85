import sys

import pytest


@pytest.fixture(scope="session", autouse=True)
def one_thread() -> None:
    """Keep torch from taking every core for itself; and sums in one order."""
    torch = sys.modules.get("torch")
    if torch is not None:
        torch.set_num_threads(1)
