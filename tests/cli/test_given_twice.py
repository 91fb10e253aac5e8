"""No option loses a value: each is repeatable, or a usage error if it is given twice."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest

from crowdbot import cli
from crowdbot.cli.app.command_names import command_names
from crowdbot.cli.app.typer_app import load


def _commands() -> Iterator[tuple[list[str], Any]]:
    """Yield the words and the parser's command of each command and subcommand."""
    for name in command_names():
        command = load(name)
        yield [name], command
        for sub, found in getattr(command, "commands", {}).items():
            yield [name, sub], found


def _options() -> Iterator[tuple[list[str], Any, Any, str]]:
    for words, command in _commands():
        for param in command.params:
            if param.param_type_name == "option":
                for text in (*param.opts, *param.secondary_opts):
                    yield words, command, param, text


#: Each spelling of each option of each command.
OPTIONS = list(_options())


def _value(param: Any) -> list[str]:
    return [] if param.is_flag else ["1"]


def test_all_are_looked_at() -> None:
    assert len({tuple(words) for words, *_ in OPTIONS}) > 25
    assert len(OPTIONS) > 180


@pytest.mark.parametrize("words", sorted({" ".join(words) for words, *_ in OPTIONS}))
def test_every_option_of(words: str, capsys: pytest.CaptureFixture[str]) -> None:
    for path, command, param, text in OPTIONS:
        if " ".join(path) != words:
            continue
        given = [text, *_value(param)]
        if param.multiple:
            # The command keeps the help's names of its first context, also for later tests.
            names = {"help_option_names": ["-h", "--help"]}
            context = command.context_class(command, info_name=path[-1], **names)
            values, _, _ = command.make_parser(context).parse_args([*given, *given])
            assert values[param.name] == ["1", "1"], text
            continue
        assert cli.main([*path, *given, *given]) == 2, text
        assert "given twice" in " ".join(capsys.readouterr().err.split()), text


@pytest.mark.parametrize("option", ["-v", "--version", "-q"])
def test_options_before_the_command(option: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([option, option, "expand", "challenge-2020"]) == 2
    assert "given twice" in capsys.readouterr().err


def test_two_spellings_of_one_option(capsys: pytest.CaptureFixture[str]) -> None:
    argv = ["simulate", "challenge-2020", "x", "--in-process", "--own-process"]
    assert cli.main(argv) == 2
    assert "--in-process/--own-process is given twice" in capsys.readouterr().err


def test_scenarios_that_match_any_pattern(capsys: pytest.CaptureFixture[str]) -> None:
    first, second = "in-d0125-slow-c01-*", "counter-d0500-fast-c50-r10"
    argv = ["expand", "challenge-2020", "--only", second, "--only", first, "--json"]
    assert cli.main(argv) == 0
    ids = [row["id"] for row in json.loads(capsys.readouterr().out)]
    assert ids == [*(f"in-d0125-slow-c01-r{r}" for r in ("02", "05", "10")), second]


def test_a_pattern_without_a_match(capsys: pytest.CaptureFixture[str]) -> None:
    argv = ["--only", "in-*", "--only", "inn-*"]
    assert cli.main(["expand", "challenge-2020", *argv]) == 1
    assert "'inn-*'" in capsys.readouterr().err
    assert cli.main(["campaign", "challenge-2020", "--planner", "dwa", "--dry-run", *argv]) == 1
    assert "'inn-*'" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["campaign", "audit"])
def test_the_plan_has_all_patterns(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    only = ["--only", "in-d0125-slow-c01-r02", "--only", "counter-d0125-slow-c01-r02"]
    planner = ["--planner", "dwa", "--no-floors"] if command == "campaign" else []
    assert cli.main([command, "challenge-2020", *only, *planner, "--dry-run", "--json"]) == 0
    both = json.loads(capsys.readouterr().out)["runs"]
    assert cli.main([command, "challenge-2020", *only[:2], *planner, "--dry-run", "--json"]) == 0
    assert both == 2 * json.loads(capsys.readouterr().out)["runs"]
