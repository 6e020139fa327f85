from pathlib import Path

from training.errors import TrainingError

PAGE = Path(__file__).resolve().parents[2] / "docs" / "training.md"


def test_every_code_is_its_own_and_explained() -> None:
    codes = [TrainingError.code, *(kind.code for kind in TrainingError.__subclasses__())]
    assert len(set(codes)) == len(codes) == 6
    page = PAGE.read_text("utf-8")
    assert all(f"| `{code}` |" in page for code in codes)
