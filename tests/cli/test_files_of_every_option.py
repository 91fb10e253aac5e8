"""Each argument and option that takes a file: a pipe, a device and a huge file end as an error.

The table below must name every parameter of every command, so that a new one is thought of.
"""

from __future__ import annotations

import importlib
import inspect
import os
import resource
import signal
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

from crowdbot.cli import main
from crowdbot.cli.app.command_names import command_groups, module_name
from tests.paths import DATA

SHORT, TABLE = str(DATA / "short_way.yaml"), str(DATA / "recordings" / "format_3.mcap")
#: Command and parameter -> command line, ``{}`` is the file; the ending of its name.
TAKEN: dict[tuple[str, str], tuple[str, ...]] = {
    ("audit", "suite"): (".yaml", "audit", "{}"),
    ("audit", "careful"): (".yaml", "audit", SHORT, "--adversaries", "--careful", "{}"),
    ("bundle", "root"): ("", "bundle", "{}"),
    ("bundle", "suite"): (".yaml", "bundle", "RUNS", "--suite", "{}", "--planner", "dwa"),
    ("bundle", "source"): (".yaml", "bundle", "RUNS", "--check", "--source", "{}"),
    ("calibrate", "crowd"): (".yaml", "calibrate", "{}"),
    ("calibrate", "reference"): (".csv", "calibrate", "rvo", "--reference", "{}"),
    ("calibrate", "homography"): (
        ".txt", "calibrate", "rvo", "--reference", "a.csv", "--homography", "{}",
    ),
    ("campaign", "suites"): (".yaml", "campaign", "{}", "--planner", "dwa", "--out", "RUNS"),
    ("campaign", "planner"): (
        ".yaml", "campaign", SHORT, "--planner", "{}", "--out", "RUNS", "--no-floors",
    ),
    ("campaign", "crowds"): (
        ".yaml", "campaign", SHORT, "--planner", "dwa", "--crowds", "{}", "--out", "RUNS",
    ),
    ("diff", "a"): (".yaml", "diff", "{}", SHORT),
    ("diff", "b"): (".yaml", "diff", SHORT, "{}"),
    ("draws commit", "suite"): (".yaml", "draws", "commit", "{}"),
    ("draws commit", "seed_file"): (
        ".txt", "draws", "commit", SHORT, "--seed-file", "{}", "--print", "--secret", "RUNS/s",
    ),
    ("draws reveal", "suite"): (".yaml", "draws", "reveal", "{}"),
    ("draws reveal", "secret"): (".json", "draws", "reveal", SHORT, "--secret", "{}"),
    ("draws check", "suite"): (".yaml", "draws", "check", "{}"),
    ("edit", "spec"): (".yaml", "edit", "{}", "--no-open"),
    ("evaluate", "runs"): (".mcap", "evaluate", "{}"),
    ("evaluate", "robot_alone"): (".mcap", "evaluate", TABLE, "--robot-alone", "{}"),
    ("evaluate", "crowd_alone"): (".mcap", "evaluate", TABLE, "--crowd-alone", "{}"),
    ("evaluate", "commands"): (".csv", "evaluate", TABLE, "--commands", "{}"),
    ("evaluate", "commands_baseline"): (".csv", "evaluate", TABLE, "--commands-baseline", "{}"),
    ("evaluate", "questionnaires"): (".csv", "evaluate", TABLE, "--questionnaires", "{}"),
    ("expand", "spec"): (".yaml", "expand", "{}"),
    ("export", "run"): (".mcap", "export", "{}", "--to", "csv"),
    ("export-map", "spec"): (".yaml", "export-map", "{}"),
    ("export-trial", "spec"): (".yaml", "export-trial", "{}", "--out", "RUNS/trial.xml"),
    ("export-urdf", "spec"): (".yaml", "export-urdf", "robot", "--spec", "{}"),
    ("import", "homography"): (".txt", "import", "a.csv", "--homography", "{}"),
    ("import", "files"): (".xml", "import", "{}", "--out", "RUNS/imported.yaml"),
    ("info", "file"): (".mcap", "info", "{}"),
    ("leaderboard", "folder"): ("", "leaderboard", "{}", "--out", "RUNS/l.html"),
    ("leaderboard", "suite"): (".yaml", "leaderboard", "RUNS", "--suite", "{}"),
    ("leaderboard", "audit"): (".json", "leaderboard", "RUNS", "--audit", "{}"),
    ("challenge-page", "suite"): (".yaml", "challenge-page", "{}", "--out", "RUNS"),
    ("challenge-page", "bundles"): ("", "challenge-page", SHORT, "{}", "--out", "RUNS"),
    ("judge", "suite"): (".yaml", "judge", "{}", "RUNS"),
    ("judge", "submissions"): ("", "judge", SHORT, "{}"),
    ("judge-log", "log"): (".jsonl", "judge-log", "{}"),
    ("lock", "spec"): (".yaml", "lock", "{}"),
    ("realism", "crowd"): (".yaml", "realism", "{}"),
    ("realism", "reference"): (".csv", "realism", "rvo", "--reference", "{}"),
    ("realism", "homography"): (
        ".txt", "realism", "rvo", "--reference", "a.csv", "--homography", "{}",
    ),
    ("recover", "file"): (".mcap", "recover", "{}"),
    ("references make", "suites"): (".yaml", "references", "make", "{}", "--runs", "RUNS"),
    ("references make", "extend"): (
        ".json.xz", "references", "make", SHORT, "--extend", "{}", "--runs", "RUNS",
    ),
    ("references make", "planner"): (
        ".yaml", "references", "make", SHORT, "--planner", "{}", "--runs", "RUNS",
    ),
    ("report", "root"): ("", "report", "{}"),
    ("report", "reference"): ("", "report", "RUNS", "--reference", "{}"),
    ("report", "audit"): (".json", "report", "RUNS", "--audit", "{}"),
    ("results export", "out"): ("", "results", "export", "{}"),
    ("results failures", "out"): ("", "results", "failures", "{}"),
    ("results atlas", "out"): ("", "results", "atlas", "{}"),
    ("results power", "reference"): ("", "results", "power", "--reference", "{}"),
    ("seal", "planner"): (".yaml", "seal", "{}"),
    ("serve", "spec"): (".yaml", "serve", "{}"),
    ("simulate", "spec"): (".yaml", "simulate", "{}", "--out", "RUNS"),
    ("simulate", "planner"): (".yaml", "simulate", SHORT, "--out", "RUNS", "--planner", "{}"),
    ("study plan", "file"): (".yaml", "study", "plan", "{}"),
    ("study run", "file"): (".yaml", "study", "run", "{}", "--synthetic"),
    ("study results", "file"): (".yaml", "study", "results", "{}"),
    ("study report", "file"): (".yaml", "study", "report", "{}"),
    ("teleop", "spec"): (".yaml", "teleop", "{}", "--out", "RUNS"),
    ("teleop", "planner"): (".yaml", "teleop", SHORT, "--out", "RUNS", "--planner", "{}"),
    ("teleop", "replay"): (".mcap", "teleop", SHORT, "--out", "RUNS", "--replay", "{}"),
    ("validate", "specs"): (".yaml", "validate", "{}"),
    ("verify", "bundle"): (".cbz", "verify", "{}"),
    ("verify", "suite"): (".yaml", "verify", "RUNS/none.cbz", "--suite", "{}"),
    ("walk", "spec"): (".yaml", "walk", "{}", "--out", "RUNS"),
    ("walk", "planner"): (".yaml", "walk", SHORT, "--out", "RUNS", "--planner", "{}"),
    ("walk", "replay"): (".mcap", "walk", SHORT, "--out", "RUNS", "--replay", "{}"),
    ("view", "spec"): (".yaml", "view", "{}"),
    ("why", "path"): ("", "why", "{}"),
    ("weights", "file"): (".pth", "weights", "{}"),
    ("view", "others"): (".yaml", "view", "RUNS", "{}", "--out", "RUNS/v.html"),
    ("view", "reference"): ("", "view", "RUNS", "--reference", "{}", "--out", "RUNS/v.html"),
}  # fmt: skip
#: Parameters that name no file to read: names, numbers, addresses, and what is written.
NO_FILES = {
    "accept", "allow_origin", "environment", "include", "key", "known", "trust",
    "at", "axes", "by", "cluster", "command_topic", "commitment", "connect",
    "contact", "csv", "distro", "fit", "folder", "host", "id_", "kind", "md", "metric", "metrics",
    "name",
    "one", "only", "out", "overrides", "page", "parquet", "planner", "planner_set", "robot",
    "scenario", "search", "secret", "seeds", "suite", "team", "title", "token", "user_topic",
    "variant", "zenoh", "floor", "source", "goal",
    "data", "orders", "participant", "scores",  # of studies
    "runs",
    "vary", "how",  # of sweeps
}  # fmt: skip
#: Read after something else that an empty folder lacks, by a reader that the others test.
NOT_REACHED = {
    ("bundle", "source"), ("leaderboard", "audit"), ("report", "reference"), ("report", "audit"),
    ("view", "reference"),
    ("verify", "suite"),
}  # fmt: skip
#: Seconds after which a command counts as one that waits for ever.
PATIENCE = 30


def _parameters() -> Iterator[tuple[str, str, Any]]:
    for name, group in command_groups().items():
        module = module_name(name)
        found = getattr(importlib.import_module(f"crowdbot.cli.commands.{group}.{module}"), module)
        functions = [(name, found)]
        if isinstance(found, typer.Typer):
            named = ((c.name, c.callback) for c in found.registered_commands)
            functions = [(f"{name} {n or getattr(f, '__name__', '')}", f) for n, f in named]
        for shown, function in functions:
            for parameter in inspect.signature(function, eval_str=True).parameters.values():
                yield shown, parameter.name, typing.get_args(parameter.annotation)[0]


def test_the_table_names_each_parameter() -> None:
    known = {(command, name) for command, name, _ in _parameters()}
    assert set(TAKEN) <= known
    for command, name, kind in _parameters():
        if name == "plugin" or not ("Path" in str(kind) or "str" in str(kind)):
            continue  # plugins: tests/cli/test_plugin_paths.py
        assert (command, name) in TAKEN or name in NO_FILES, (command, name)


@pytest.fixture(autouse=True)
def _bounded() -> Iterator[None]:
    """End a test that waits for a pipe, or reads a device into memory."""

    def late(*_: object) -> None:
        raise AssertionError("the command waits for ever")

    before = resource.getrlimit(resource.RLIMIT_AS)
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + (4 << 30), before[1]))
    usual = signal.signal(signal.SIGALRM, late)
    signal.alarm(PATIENCE)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, usual)
    resource.setrlimit(resource.RLIMIT_AS, before)


def _pipe(path: Path) -> None:
    os.mkfifo(path)


def _device(path: Path) -> None:
    path.symlink_to("/dev/zero")


def _huge(path: Path) -> None:
    with path.open("wb") as file:
        file.truncate(2 << 40)


def _binary(path: Path) -> None:
    path.write_bytes(bytes(range(256)) * 10)


@pytest.mark.parametrize("make", [_pipe, _device, _huge, _binary])
@pytest.mark.parametrize("place", TAKEN, ids=lambda place: " ".join(place))
def test_no_plain_text_is_an_error(
    place: tuple[str, str],
    make: Any,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "400")  # wrapped lines would split names of files
    ending, *words = TAKEN[place]
    file = tmp_path / f"given{ending}"
    make(file)
    (tmp_path / "RUNS").mkdir()
    code = main([word.format(file) for word in words])
    output = capsys.readouterr().err
    assert code in (1, 2), output
    assert "internal error" not in output
    assert place in NOT_REACHED or "given" in output or "/dev/zero" in output
