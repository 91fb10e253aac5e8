from __future__ import annotations

import os
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

from crowdbot import cli
from crowdbot.cli.app.typer_app import load
from crowdbot.core.registry.plugin_errors import UserInterrupt
from crowdbot.errors import CrowdbotError, PluginError, SimulationError, UsageError
from tests.waiting import AT_MOST

COMMANDS = [c for c in cli.command_names() if c in ("validate", "expand", "plugins")]


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("crowdbot 0.")


@pytest.mark.parametrize("flag", ["-h", "--help"])
def test_help_lists_every_command(flag: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([flag]) == 0
    shown = capsys.readouterr().out
    assert COMMANDS == ["expand", "plugins", "validate"]
    assert all(name in shown for name in cli.command_names())
    assert "Example" in shown


@pytest.mark.parametrize("command", cli.command_names())
def test_every_commands_help_has_an_example(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main([command, "-h"]) == 0
    shown = capsys.readouterr().out
    assert "Example" in shown
    assert f"crowdbot {command}" in shown
    common = " ".join(shown.split()).partition("Common options: ")[2]
    assert "-v prints more; -q prints errors only; -h shows this help." in common


@pytest.mark.parametrize(
    "argv", [["validte"], ["validate"], ["validate", "--nope", "x"], ["expand", "a", "b"], ["-x"]]
)
def test_usage_errors(argv: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(argv) == 2
    assert capsys.readouterr().err


def test_a_mistyped_command_gets_a_hint(capsys: pytest.CaptureFixture[str]) -> None:
    cli.main(["validat"])
    assert "did you mean 'validate'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("error", "code", "text"),
    [
        (UsageError("use it well"), 2, "error: use it well"),
        (PluginError("acme broke"), 3, "error: acme broke"),
        (SimulationError("no"), 4, "error: no"),
        (CrowdbotError("x"), 1, "error: x"),
        (UserInterrupt(), 130, ""),
        (PermissionError(13, "Permission denied", "f"), 1, "error: f: Permission denied"),
        (ZeroDivisionError("z"), 4, f"internal error ZeroDivisionError: z ({__file__}:"),
        (KeyboardInterrupt(), 3, f"error: a plugin raised KeyboardInterrupt ({__file__}:"),
        (SystemExit(0), 3, f"error: a plugin raised SystemExit: 0 ({__file__}:"),
    ],
)
def test_exit_codes(
    error: BaseException,
    code: int,
    text: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def fail(**_: object) -> None:
        raise error

    monkeypatch.delenv("CROWDBOT_DEBUG", raising=False)
    monkeypatch.setattr("crowdbot.core.registry.registry.discover", fail)
    assert cli.main(["plugins"]) == code
    shown = capsys.readouterr().err
    assert shown.startswith(text)
    assert "Traceback" not in shown


def test_the_reason_of_a_librarys_exit_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(words: list[str]) -> None:
        raise SystemExit(f"Failure at joint.h:435, {len(words)} words")

    monkeypatch.delenv("CROWDBOT_DEBUG", raising=False)
    monkeypatch.setattr("crowdbot.cli._dispatch", fail)
    monkeypatch.setattr("crowdbot.cli.left_by", lambda _: "")
    assert cli.main(["plugins"]) == 4
    assert "internal error RuntimeError: Failure at joint.h:435" in capsys.readouterr().err


def test_debug_shows_the_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(**_: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setenv("CROWDBOT_DEBUG", "1")
    monkeypatch.setattr("crowdbot.core.registry.registry.discover", fail)
    with pytest.raises(ZeroDivisionError):
        cli.main(["plugins"])


def run(*code: str, **env: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *code],
        capture_output=True,
        text=True,
        env={**os.environ, **env},
        timeout=AT_MOST,
        check=False,
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    "argv", [["validate", "challenge-2020"], ["expand", "challenge-2020"], ["plugins"], ["--help"]]
)
def test_words_load_neither_drake_nor_numba(argv: list[str]) -> None:
    code = (
        "import sys; from crowdbot.cli import main; code = main(sys.argv[1:]); "
        "heavy = {'pydrake', 'numba', 'numpy', 'mcap', 'rosbags'} & set(sys.modules); "
        "assert not heavy, heavy; sys.exit(code)"
    )
    done = run("-c", code, *argv)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("argv", [["validate", "challenge-2020"], ["expand", "challenge-2020"]])
def test_names_alone_load_no_metric_or_planner(argv: list[str]) -> None:
    """Each would take a tenth of the command's time."""
    code = (
        "import sys; from crowdbot.cli import main; code = main(sys.argv[1:]); "
        "more = {'crowdbot.plugins.metrics', 'crowdbot.plugins.planners'}; "
        "assert not more & set(sys.modules), more & set(sys.modules); sys.exit(code)"
    )
    done = run("-c", code, *argv)
    assert done.returncode == 0, done.stderr


def test_module_can_be_run() -> None:
    assert run("-m", "crowdbot", "--version").stdout.startswith("crowdbot ")


@pytest.mark.slow
def test_a_closed_pipe_is_no_error() -> None:
    command = f"set -o pipefail; {sys.executable} -m crowdbot expand challenge-2020 | head -1"
    done = subprocess.run(
        ["bash", "-c", command], capture_output=True, text=True, timeout=AT_MOST, check=False
    )
    assert done.stdout.startswith("in-d0125-slow-c01-r02")
    assert done.stderr == ""


@pytest.mark.parametrize("words", [("expand", "challenge-2020"), ("plugins",), ("--help",)])
def test_nobody_reads_at_all(words: tuple[str, ...]) -> None:
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [sys.executable, "-m", "crowdbot", *words], stdout=write, stderr=subprocess.PIPE,
        text=True, timeout=AT_MOST, check=False,
    )  # fmt: skip
    os.close(write)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.slow
def test_no_colours_without_a_terminal() -> None:
    for env in ({}, {"NO_COLOR": "1"}):
        assert "\x1b" not in run("-m", "crowdbot", "--help", **env).stdout


def test_output_in_any_encoding() -> None:
    done = run("-m", "crowdbot", "plugins", "show", "lidar2d", PYTHONIOENCODING="ascii")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("command", cli.command_names())
def test_who_adds_plugins_can_leave_out_the_installed_ones(command: str) -> None:
    for name, one in {command: (top := load(command)), **getattr(top, "commands", {})}.items():
        options = {text for param in one.params for text in param.opts}
        assert ("--plugin" in options) == ("--no-plugins" in options), name


def test_warnings_of_recordings_are_plain_lines(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "people.vsp"
    file.write_text("1 - the number of splines\n2\n0 0 0 0\n6 0 100 0\n")
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        assert cli.main(["realism", "orca", "--reference", str(file), "--seeds", "1"]) == 1
    first = capsys.readouterr().err.splitlines()[0]
    taken = "positions are taken for metres: people walk at 1.5 m/s (median)"
    assert first == f"warning: {file}: {taken}"
