"""``--out`` means the same in every command: folders are made, and the same text say why not."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from crowdbot import cli
from crowdbot.cli.app.command_names import command_names
from crowdbot.cli.app.typer_app import load
from tests.core.bundle.made_up_runs import make_bundle

WRITERS = {
    "schema": (["schema", "suite"], "s.json"),
    "export-urdf": (["export-urdf", "robot", "--spec", "challenge-2020"], "r.urdf"),
    "export-map": (["export-map", "social-guidelines", "crossing_left"], "map"),
    "view": (["view", "social-guidelines", "crossing_left"], "v.html"),
    "leaderboard": (["leaderboard", "BUNDLES"], "l.html"),
}


@pytest.fixture(scope="module")
def bundles(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bundles")
    make_bundle(folder)
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("name", WRITERS)
def test_folders_are_made_and_files_are_not_folders(
    name: str, bundles: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words, file = WRITERS[name]
    words = [str(bundles) if word == "BUNDLES" else word for word in words]
    out = tmp_path / "not" / "yet" / file
    assert cli.main([*words, "--out", str(out)]) == 0
    assert out.exists()
    assert not list(out.parent.glob(".*.part"))
    (tmp_path / "file").write_text("")
    capsys.readouterr()
    assert cli.main([*words, "--out", str(tmp_path / "file" / "x" / file)]) == 1
    output = re.sub(r"\s+", " ", capsys.readouterr().err)
    assert file in output
    assert "cannot be written: Not a directory" in output


def test_a_page_is_called_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for words in (["leaderboard", "x"], ["report", "x"], ["realism", "calibrated"]):
        assert cli.main([*words, "--out", str(tmp_path / "x.txt")]) == 2
        assert "the name must end in .html" in capsys.readouterr().err


def test_help_says_what_is_written() -> None:
    """``FILE``: File to write; ``DIR``: Folder to write, or the root of runs."""
    wanted = {
        "FILE": ("File to write",),
        "DIR": ("Folder to write", "Root of the run directories", "Where runs would go"),
        "PATH": ("File or folder to write",),
    }
    found = 0
    for command in (c for name in command_names() for c in _commands(load(name))):
        for option in command.params:
            if "--out" in option.opts and "--runs" not in option.opts:
                found += 1
                assert option.help.startswith(wanted[option.metavar]), (command.name, option.help)
    assert found > 15


def _commands(command: Any) -> list[Any]:
    """A command, and those below it."""
    below = getattr(command, "commands", {})
    return [command, *(c for one in below.values() for c in _commands(one))]


def test_links_in_a_circle_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    loop = tmp_path / "loop"
    loop.symlink_to(loop)
    words = ["challenge-2020", "--only", "in-d0125-slow-c01-r02", "--planner", "goal_seek"]
    assert cli.main(["campaign", *words, "--no-floors", "--out", str(loop)]) == 1
    output = re.sub(r"\s+", "", capsys.readouterr().err)
    assert f"{loop}:Toomanylevelsofsymboliclinks" in output
