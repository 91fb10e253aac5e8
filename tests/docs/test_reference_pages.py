"""Commands, hooks and contracts, compared with what the code has."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Any, get_args

import pytest

from crowdbot import hookspecs
from crowdbot.cli import command_names
from crowdbot.cli.app.typer_app import load
from crowdbot.core.crowd.build import build_cost
from crowdbot.core.crowd.velocity_search.records import AGENT, COST_PARAMS, NEIGHBOUR, WALL
from crowdbot.core.registry.registry import discover
from crowdbot.core.results.rows import RUN_COLUMNS
from crowdbot.core.support.records import RecordType
from crowdbot.dsl.scenario.stream import Stream
from crowdbot.dsl.scenario.streams import StreamChoice
from tests.docs.doc_pages import read, section

COMMANDS, PLUGINS = read("reference/commands.md"), read("reference/plugins.md")
EVERYWHERE = {"--verbose", "-v", "--quiet", "-q"}


def _commands() -> Iterator[tuple[str, Any]]:
    for name in command_names():
        command = load(name)
        yield name, command
        for inner, child in getattr(command, "commands", {}).items():
            yield f"{name} {inner}", child


LIVE = dict(_commands())


def _options(command: Any) -> set[str]:
    params = [p for p in command.params if p.param_type_name == "option" and not p.hidden]
    return {o for p in params for o in (*p.opts, *p.secondary_opts)} - EVERYWHERE


def test_every_command_has_a_heading_and_no_other() -> None:
    assert re.findall(r"^## crowdbot (.*)$", COMMANDS, re.M) == _in_page_order()


def _in_page_order() -> list[str]:
    order = ["validate", "expand", "schema", "diff", "view", "lock"]
    order += ["simulate", "evaluate", "plugins"]
    assert set(order) <= set(command_names())
    return sorted(LIVE, key=lambda n: order.index(n.split()[0]) if n.split()[0] in order else 99)


@pytest.mark.parametrize("name", LIVE)
def test_every_option_is_described_and_no_other(name: str) -> None:
    text = section(COMMANDS, f"## crowdbot {name}")
    rows = "\n".join(re.findall(r"^\|([^|]*(?:\\\|[^|]*)*)\|", text, re.M))
    assert set(re.findall(r"(?<![\w-])--?[a-z][a-z-]*", rows)) == _options(LIVE[name])


@pytest.mark.parametrize("name", LIVE)
def test_every_command_has_an_example(name: str) -> None:
    assert f"$ crowdbot {name}" in section(COMMANDS, f"## crowdbot {name}")


def test_options_of_every_command_are_named_once() -> None:
    head = COMMANDS.partition("\n## ")[0]
    assert all(f"`{option}`" in head for option in EVERYWHERE)


def _signature(function: Any) -> str:
    return str(inspect.signature(function)).replace("'", "")


HOOKS = {n: h for n, h in vars(hookspecs).items() if n.startswith("crowdbot_")}


@pytest.mark.parametrize("name", HOOKS)
def test_every_hook_is_described_with_its_signature(name: str) -> None:
    assert f"`{name}{_signature(HOOKS[name])}`" in section(PLUGINS, f"### {name}")


def test_no_other_hook_is_described() -> None:
    assert set(re.findall(r"^### (crowdbot_\w+)$", PLUGINS, re.M)) == set(HOOKS)


def _protocols() -> dict[str, Any]:
    from crowdbot.core.crowd import policy

    return {
        name: value
        for name, value in vars(policy).items()
        if getattr(value, "_is_protocol", False) and value.__module__ == policy.__name__
    }


@pytest.mark.parametrize("name", _protocols())
def test_every_contract_is_described_with_its_signatures(name: str) -> None:
    text = section(PLUGINS, f"### {name}")
    methods = {n: m for n, m in vars(_protocols()[name]).items() if not n.startswith("_")}
    assert methods
    for method, value in methods.items():
        function = value.fget if isinstance(value, property) else value
        assert f"def {method}{_signature(function)}\n" in text


@pytest.mark.parametrize("kind", discover(allow=()).components("cost function"))
def test_cost_functions_have_the_described_arguments(kind: str) -> None:
    registry = discover(allow=())
    component = registry.find("cost function", kind)
    cost = build_cost(registry, component.spec.model_validate({"kind": kind}))
    text = section(PLUGINS, "### Cost functions")
    for name in ("base", "prepare", "excess"):
        arguments = ", ".join(inspect.signature(getattr(cost, name).py_func).parameters)
        assert f"`{name}({arguments})`" in text


@pytest.mark.parametrize(
    ("argument", "record"),
    [("agent", AGENT), ("near", NEIGHBOUR), ("walls", WALL), ("params", COST_PARAMS)],
)
def test_fields_of_the_cost_records_are_described(argument: str, record: RecordType[Any]) -> None:
    text = section(PLUGINS, "### Cost functions")
    (row,) = re.findall(rf"^\| `{argument}` \| (.*) \|$", text, re.M)
    (names,) = re.findall(r"(?:`[a-z0-9_]+`(?:, )?)+", row.split(". ")[0])
    assert re.findall(r"`(\w+)`", names) == list(record.names)


def test_every_quantity_is_listed_with_its_unit() -> None:
    from crowdbot.dsl.spec import quantities

    found = {
        name: next(m.si_unit for m in value.__metadata__ if isinstance(m, quantities.Quantity))
        for name, value in vars(quantities).items()
        if hasattr(value, "__metadata__")
    }
    rows = re.findall(
        r"^\| ((?:`\w+`(?:, )?)+) \| (\S+) \|$", section(PLUGINS, "## Components"), re.M
    )
    listed = {name: unit for names, unit in rows for name in re.findall(r"`(\w+)`", names)}
    assert listed == found


def test_every_category_has_a_build_row() -> None:
    from crowdbot.dsl.spec.component_specs import CATEGORIES

    rows = re.findall(r"^\| ([a-z ]+) \| `build\(spec", PLUGINS, re.M)
    assert set(rows) == {c.category for c in CATEGORIES}


def _option(command: Any, name: str) -> Any:
    return next((p for p in command.params if name in p.opts), None)


@pytest.mark.parametrize("name", LIVE)
def test_every_command_says_less_and_more_alike(name: str) -> None:
    for long, short in (("--quiet", "-q"), ("--verbose", "-v")):
        option = _option(LIVE[name], long)
        assert option is not None
        assert short in option.opts


@pytest.mark.parametrize("name", LIVE)
def test_out_is_a_file_or_a_folder_and_the_only_word_for_it(name: str) -> None:
    command = LIVE[name]
    words = {o for p in command.params for o in p.opts}
    assert not words & {"-o", "--output", "--out-dir", "--output-dir", "--outfile", "--to-file"}
    if (out := _option(command, "--out")) is not None:
        assert re.fullmatch(r"DIR|PATH|FILE(\.[a-z]+)?", out.metavar or "")
        rows = section(COMMANDS, f"## crowdbot {name}")
        row = re.search(r"^\|[^|]*--out ([A-Za-z.]+)`", rows, re.M)
        assert row is not None
        assert row[1] == out.metavar


@pytest.mark.parametrize("heading", ["## Tables", "## Exported columns"])
def test_every_column_of_runs_is_described(heading: str) -> None:
    text = section(read("reference/results.md"), heading)
    missing = [name for name in RUN_COLUMNS if f"`{name}`" not in text]
    assert not missing, f"name {missing} in docs/reference/results.md, {heading}"


def test_every_kind_of_stream_is_described() -> None:
    text = read("howto/streams_of_people.md")
    kinds: list[type[Stream]] = list(get_args(get_args(StreamChoice)[0]))
    names = [stream.model_fields["kind"].default for stream in kinds]
    missing = [name for name in names if f"kind: {name}" not in text]
    assert len(kinds) > 1
    assert not missing, f"describe {missing} in docs/howto/streams_of_people.md"
