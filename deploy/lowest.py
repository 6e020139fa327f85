"""`python -m deploy.lowest`: constraints of pip that install the lowest versions which the two `pyproject.toml` allow.

They hold for what runs in production: the dependencies, and those of every extra but `dev`, whose tools only have to
work. `make test-lowest` installs them and runs the tests.
"""

import re
import sys
import tomllib

from deploy.lock import PROJECTS, ROOT

_BOUND = re.compile(r"^(?P<name>[A-Za-z0-9._-]+)(\[[^\]]*\])?>=(?P<version>[^,;\s]+)")
_NOT_RUN = "dev"


def lowest_versions() -> dict[str, str]:
    """Return the lower bound of each requirement by its name.

    Raises
    ------
    ValueError
        If a requirement has none.
    """
    project, client = (tomllib.loads((ROOT / path).read_text("utf-8"))["project"] for path in PROJECTS)
    extras = [texts for extra, texts in project["optional-dependencies"].items() if extra != _NOT_RUN]
    own = [text for text in project["dependencies"] if not text.startswith(f"{client['name']}==")]
    versions = {}
    for text in [*own, *client["dependencies"], *(text for texts in extras for text in texts)]:
        bound = _BOUND.match(text)
        if bound is None:
            raise ValueError(f"{text} has no lower bound")
        versions[bound["name"]] = bound["version"]
    return versions


if __name__ == "__main__":
    sys.stdout.writelines(f"{name}=={version}\n" for name, version in sorted(lowest_versions().items()))
