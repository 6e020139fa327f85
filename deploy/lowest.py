"""`python -m deploy.lowest`: constraints of pip that install the lowest versions which `pyproject.toml` allows.

They hold for what runs in production: the dependencies, and those of every extra but `dev`, whose tools only have to
work. `make test-lowest` installs them and runs the tests.
"""

import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
_BOUND = re.compile(r"^(?P<name>[A-Za-z0-9._-]+)(\[[^\]]*\])?>=(?P<version>[^,;\s]+)")
_NOT_RUN = "dev"


def lowest_versions() -> dict[str, str]:
    """Return the lower bound of each requirement by its name.

    Raises
    ------
    ValueError
        If a requirement has none.
    """
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extras = [texts for extra, texts in project["optional-dependencies"].items() if extra != _NOT_RUN]
    versions = {}
    for text in [*project["dependencies"], *(text for texts in extras for text in texts)]:
        bound = _BOUND.match(text)
        if bound is None:
            raise ValueError(f"{text} has no lower bound")
        versions[bound["name"]] = bound["version"]
    return versions


if __name__ == "__main__":
    sys.stdout.writelines(f"{name}=={version}\n" for name, version in sorted(lowest_versions().items()))
