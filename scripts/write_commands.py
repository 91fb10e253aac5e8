"""Help and options of commands in docs/reference/commands.md; scripts/generate.py writes them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import Enum
from pathlib import Path
from typing import Any, get_args

from crowdbot.cli import command_names
from crowdbot.cli.app.typer_app import load

PAGE = Path(__file__).parent.parent / "docs" / "reference" / "commands.md"
HEAD = "| option | |\n|---|---|\n"
_TYPES = {int: "N", float: "NUMBER"}
_EVERYWHERE = {"--verbose", "--quiet", "--help"}
_SECTION = re.compile(r"^## crowdbot (.*)\n(?:(?!^## ).*\n)*", re.MULTILINE)
_TABLE = re.compile(rf"{re.escape(HEAD)}(?:\|.*\n)*")
_HELP_BEGIN = "<!-- Written by make generate: the command's help. -->"
_HELP_END = "<!-- End of the help. -->"
_HELP = re.compile(rf"\n(?:{_HELP_BEGIN}\n(?:.*\n)*?{_HELP_END}\n\n?)?")


def page() -> str:
    """Return the page with the help of each command and a table of its options."""
    commands = dict(_commands())

    def with_help(section: re.Match[str]) -> str:
        command = commands.get(section[1])
        if command is None:
            return section[0]
        heading, rest = section[0].split("\n", 1)
        rest = _HELP.sub(lambda _: f"\n{_help(section[1], command)}\n", rest, count=1)
        table = HEAD + "".join(_rows(command))
        return f"{heading}\n{_TABLE.sub(lambda _: table, rest, count=1)}"

    return _SECTION.sub(with_help, PAGE.read_text(encoding="utf-8"))


def _help(name: str, command: Any) -> str:
    """Return how a command is called and what it does, between two comments."""
    arguments = [p for p in command.params if p.param_type_name == "argument"]
    called = " ".join(["crowdbot", name, *(p.metavar or p.name.upper() for p in arguments)])
    about = (command.help or "").partition("Example:")[0].strip()
    first, *more = (" ".join(part.split()) for part in re.split(r"\n\s*\n", about))
    text = "\n\n".join([f"`{called}`: {first[:1].lower()}{first[1:]}", *more])
    return f"{_HELP_BEGIN}\n{text}\n{_HELP_END}\n"


def _commands() -> Iterator[tuple[str, Any]]:
    """Yield name and command, those within a group behind it."""
    for name in command_names():
        command = load(name)
        yield name, command
        for inner, child in getattr(command, "commands", {}).items():
            yield f"{name} {inner}", child


def _rows(command: Any) -> Iterator[str]:
    for param in command.params:
        if param.param_type_name != "option" or param.hidden or _EVERYWHERE & set(param.opts):
            continue
        yield f"| {_names(param)} | {_about(param)} |\n"


def _names(param: Any) -> str:
    taken = "" if param.is_flag or param.count else f" {_taken(param)}"
    names = [*param.opts, *param.secondary_opts]
    return ", ".join(f"`{name}{taken}`" for name in names).replace("|", "\\|")


def _taken(param: Any) -> str:
    """Return what an option takes: its metavar, its choices, or the name of its type."""
    if param.metavar:
        return str(param.metavar)
    kind = param.type_descriptor.annotation
    inner = [kind, *get_args(kind)]
    choices = next((c for c in inner if isinstance(c, type) and issubclass(c, Enum)), None)
    return "|".join(str(c.value) for c in choices) if choices else _TYPES.get(kind, "VALUE")


def _about(param: Any) -> str:
    text = " ".join((param.help or "").split()).replace("|", "\\|")
    value = param.default
    plain = isinstance(value, str | int | float | Path) and not isinstance(value, bool)
    if plain and value != "" and param.show_default and "default" not in text.lower():
        text = f"{text.rstrip('.')}; default `{_shown(value)}`."
    return f"{text} May be repeated." if param.multiple and "repeat" not in text else text


def _shown(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(getattr(value, "value", value))
