import json
import subprocess
import sys
from pathlib import Path

import pytest

from quadpatch_client.entry import main
from quadpatch_client.exit_codes import ExitCode
from tests.waiting import GUARD_S


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["repair", "scan.ply", "-o", "o.ply", "--method", "smoth"], "'smoth' is not one of"),
        (["repair", "scan.ply", "-o", "o.ply", "--method", "smoth"], "; did you mean 'smooth'?"),
        (["repair", "scan.ply", "-o", "o.ply", "--modle", "self"], "--model"),
        (["repair", "absent.ply", "-o", "o.ply"], "'absent.ply' does not exist"),
        (["repair", "scan.ply"], "'--output' / '-o'"),
        (["repiar"], "repair"),
    ],
)
def test_wrong_usage_is_one_line_with_what_was_meant(
    arguments: list[str],
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("scan.ply").write_bytes(b"ply")
    assert main(arguments) == ExitCode.USAGE
    written = capsys.readouterr()
    first, second = written.err.splitlines()
    assert first.startswith("error: ")
    assert words in first
    assert second.startswith("see quadpatch-client")
    assert written.out == ""


@pytest.mark.parametrize(
    ("arguments", "code", "exit_code"),
    [
        (["jobs", "--state", "quued", "--json"], "usage", ExitCode.USAGE),
        (["jobs", "--json", "--url", "http://127.0.0.1:9"], "unreachable", ExitCode.UNREACHABLE),
        (["wait", "job_1", "--json", "--quiet", "--url", "http://127.0.0.1:9"], "unreachable", ExitCode.UNREACHABLE),
    ],
)
def test_errors_are_json_too_where_json_is_asked_for(
    arguments: list[str], code: str, exit_code: ExitCode, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == exit_code
    written = capsys.readouterr()
    error = json.loads(written.out)["error"]
    assert (error["code"], error["exit_code"], error["job"]) == (code, exit_code, None)
    assert error["message"] in written.err


def test_the_version_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == ExitCode.OK
    assert capsys.readouterr().out.startswith("quadpatch-client 0.")


def test_a_reader_that_has_seen_enough_is_no_error() -> None:
    command = f"{sys.executable} -m quadpatch_client --help | head -n 1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=GUARD_S, check=False)
    assert "Traceback" not in done.stderr


# What other systems lack: the package has to load, and to know its commands, without it.
HIDDEN = ("fcntl", "termios", "tty", "pwd", "grp", "resource", "pty")
WITHOUT = """
import sys
hidden = {hidden!r}
for name in hidden:
    sys.modules.pop(name, None)
class Hider:
    def find_spec(self, name, path=None, target=None):
        if name in hidden:
            raise ImportError(name)
sys.meta_path.insert(0, Hider())
import signal
for name in ("SIGKILL", "SIGHUP", "SIGUSR1", "SIGALRM", "SIGCHLD", "SIGQUIT"):
    delattr(signal, name)
import pkgutil, quadpatch_client, quadpatch_rules
for package in (quadpatch_client, quadpatch_rules):
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        if module.name not in ("quadpatch_client.__main__", "quadpatch_rules.parent_death"):
            __import__(module.name)
from pathlib import Path
from quadpatch_client.journal import Entry, Journal, Stamp, one_client_alone
with one_client_alone(Path(sys.argv[1])), Journal(Path(sys.argv[1]) / "journal") as journal:
    journal.write(Entry("a", "done", Stamp(1, 2)))
from quadpatch_client.entry import main
sys.exit(main(["--help"]))
"""


def test_it_works_without_what_windows_and_macos_lack(tmp_path: Path) -> None:
    command = [sys.executable, "-c", WITHOUT.format(hidden=HIDDEN), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=GUARD_S, check=False)
    assert done.returncode == 0, done.stderr
    assert "Repair 3D scans" in done.stdout
    assert (tmp_path / "journal").read_text().count("\n") == 1
