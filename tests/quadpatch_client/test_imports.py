import subprocess
import sys

HEAVY = {
    "sqlalchemy",
    "alembic",
    "redis",
    "rq",
    "fastapi",
    "starlette",
    "numpy",
    "trimesh",
    "quadpatch",
    "service",
    "worker",
}


def test_the_client_stays_light() -> None:
    code = "import sys, quadpatch_client.cli; print(' '.join({name.partition('.')[0] for name in sys.modules}))"
    loaded = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.split()
    assert HEAVY.isdisjoint(loaded)
