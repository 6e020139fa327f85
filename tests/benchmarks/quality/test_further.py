import zipfile
from pathlib import Path

from benchmarks.quality.further import FURTHER, collect, look_up


def test_a_file_is_found_in_a_wheel_and_at_the_end_of_a_path_in_a_folder(tmp_path: Path) -> None:
    wheel = tmp_path / "some.whl"
    with zipfile.ZipFile(wheel, "w") as file:
        file.writestr("some/meshes/bone.stl", b"bone")
    folder = tmp_path / "folder" / "deep" / "Data"
    folder.mkdir(parents=True)
    (folder / "horse.ply").write_bytes(b"horse")
    assert look_up(wheel, "some/meshes/bone.stl") == b"bone"
    assert look_up(wheel, "meshes/bone.stl") is None
    assert look_up(tmp_path / "folder", "Data/horse.ply") == b"horse"
    assert look_up(tmp_path / "folder", "Data/cow.ply") is None


def test_what_is_found_is_copied_and_what_is_not_is_named(tmp_path: Path) -> None:
    horse = next(mesh for mesh in FURTHER if mesh.name == "horse")
    (tmp_path / "in" / "Data").mkdir(parents=True)
    (tmp_path / "in" / horse.path).write_bytes(b"horse")
    missing = collect(tmp_path / "out", [tmp_path / "in"])
    assert missing == [mesh for mesh in FURTHER if mesh.name != "horse"]
    assert (tmp_path / "out" / "horse.ply").read_bytes() == b"horse"


def test_there_are_ten_and_no_name_or_file_comes_twice() -> None:
    assert len(FURTHER) == 10
    assert len({mesh.name for mesh in FURTHER}) == len({mesh.path for mesh in FURTHER}) == 10
