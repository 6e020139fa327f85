"""``python -m benchmarks.quality.assemble DOCUMENT RUN=FOLDER...``: put the tables and plots of runs into a document.

The document says where, by comments::

    <!-- results: bench/repair -->
    whatever stands here is replaced
    <!-- end of results -->

with the run's name, as given on the command line, and the experiment's, whose Markdown lies in the run's folder. Plots
are copied to ``images/results`` beside the document.
"""

import argparse
import re
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path

IMAGES = Path("images") / "results"
END = "<!-- end of results -->"
_PLACE = re.compile(rf"(<!-- results: ([\w-]+)/([\w-]+) -->\n).*?{END}", re.DOTALL)
_IMAGE = re.compile(r"(!\[[^\]]*\]\()([^)/]+)(\))")


def main() -> None:
    """Fill the document; print which places stayed as they were."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.quality.assemble",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("document", type=Path)
    parser.add_argument("run", nargs="+", help="name of a run, =, and its output folder")
    arguments = parser.parse_args()
    runs = {name: Path(folder) for name, _, folder in (run.partition("=") for run in arguments.run)}
    untouched = assemble(arguments.document, runs)
    if untouched:
        sys.stderr.write(f"no results yet for {', '.join(untouched)}\n")


def assemble(document: Path, runs: Mapping[str, Path]) -> list[str]:
    """Replace what stands in the places for which a run has results; return the places for which none has."""
    untouched: list[str] = []

    def fill(place: re.Match[str]) -> str:
        head, run, experiment = place.groups()
        fragment = runs.get(run, Path()) / f"{experiment}.md"
        if run not in runs or not fragment.is_file():
            untouched.append(f"{run}/{experiment}")
            return place.group()
        return f"{head}\n{_with_images(fragment, run, document.parent)}\n{END}"

    text = _PLACE.sub(fill, document.read_text("utf-8"))
    document.write_text(text, "utf-8")
    return untouched


def _with_images(fragment: Path, run: str, folder: Path) -> str:
    """Copy the images of a fragment to the document's folder, and have the links lead there."""

    def copy(image: re.Match[str]) -> str:
        before, name, after = image.groups()
        target = IMAGES / f"{run}_{name}"
        (folder / target).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(fragment.parent / name, folder / target)
        return f"{before}{target.as_posix()}{after}"

    return _IMAGE.sub(copy, fragment.read_text("utf-8"))


if __name__ == "__main__":
    main()
