"""A lock: which scenarios a suite has, with hashes, and the agents that were drawn for them.

Two files beside ``NAME.yaml``: ``NAME.lock.json`` (`Lock`) and ``NAME.agents.csv``, all tables one
below the other, whose first column, ``draw``, names the table. Text only: nothing is drawn here,
and no table is turned into numbers.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

from annotated_types import Ge
from pydantic import Field, ValidationError

from crowdbot.dsl.spec.spec import Spec
from crowdbot.errors import InputError

#: The version of the lock format that this release reads and writes.
LOCK = 1

Values = dict[str, Any]


class LockedTable(Spec):
    """A table of agents."""

    inputs: str = Field(description="Hash of everything that the drawing depends on.")
    realisation: str = Field(description="Hash of the table.")


class LockedScenario(Spec):
    """What is frozen of one scenario."""

    spec: str = Field(description="Hash of the scenario.")
    realisation: str = Field(description="Hash of its agents.")
    draw: str | None = Field(description="Which table; null: nobody walks here.")
    values: Values = Field(description="Its fields that are not 'common'.")


class Lock(Spec):
    """The content of ``NAME.lock.json``.

    ``common`` and the ``values`` of each scenario say what the hashes were made from, so that a
    difference can be named.
    """

    lock: Annotated[int, Ge(1)] = Field(description="Version of this file's format.")
    crowdbot: str = Field(description="Version of crowdbot that wrote it.")
    suite: str = Field(description="Id of the suite.")
    kinds: dict[str, int] = Field(description="Kind -> spec_version of all components.")
    common: Values = Field(description="Fields that are equal in all scenarios.")
    draws: dict[str, LockedTable] = Field(description="The tables, by name.")
    scenarios: dict[str, LockedScenario] = Field(description="By id, in the suite's order.")

    def table_of(self, inputs: str) -> str | None:
        """The name of the table that was drawn from these inputs."""
        return self._by_inputs.get(inputs)

    @cached_property
    def _by_inputs(self) -> dict[str, str]:
        return {table.inputs: name for name, table in self.draws.items()}

    def values_of(self, id_: str) -> Values:
        """All fields of one scenario when it was locked, by dotted path."""
        return {**self.common, **self.scenarios[id_].values}

    def text(self) -> str:
        """The file: JSON, one line a scenario, a table or a common field."""
        parts = []
        for name, value in self.model_dump(mode="json").items():
            if isinstance(value, dict) and value:
                rows = ",\n".join(f"  {json.dumps(k)}: {json.dumps(v)}" for k, v in value.items())
                parts.append(f"{json.dumps(name)}: {{\n{rows}\n}}")
            else:
                parts.append(f"{json.dumps(name)}: {json.dumps(value)}")
        return "{\n" + ",\n".join(parts) + "\n}\n"


class LockFiles:
    """The two files of a lock, read when somebody asks.

    Args:
        document: the suite file that they stand beside.
        spec: how users name the suite; messages say what to call again.
    """

    def __init__(self, document: Path, spec: str) -> None:
        self.lock_path, self.agents_path = lock_paths(document)
        self.spec = spec

    def __deepcopy__(self, memo: object) -> LockFiles:
        return self

    @cached_property
    def lock(self) -> Lock:
        """The lock.

        Raises:
            InputError: there is none, or it is not a lock.
        """
        return parse_lock(_read(self.lock_path), self.lock_path.name, self.spec)

    @cached_property
    def tables(self) -> dict[str, str]:
        """Name -> table as text; "" -> a table of nobody.

        Raises:
            InputError: the file is missing, or is not such a file.
        """
        return split_tables(_read(self.agents_path), self.agents_path.name)

    def check_tables(self) -> None:
        """Whether the file of the tables is such a file; nothing is made of it if that is seen.

        Raises:
            InputError: as of `tables`.
        """
        if "tables" not in self.__dict__ and not _is_plain(_read(self.agents_path)):
            _ = self.tables

    def table(self, name: str) -> str:
        """One table as text; its hash is the one of the lock.

        Raises:
            InputError: it is missing or was changed.
        """
        text = self.tables.get(name, self.tables[""])
        if table_hash(text) != self.lock.draws[name].realisation:
            what = "was changed" if name in self.tables else "is missing"
            raise InputError(
                f"{self.agents_path.name}: table '{name}' {what} since {self.lock_path.name} was "
                f"written; restore the file, or run {self.command}"
            )
        return text

    @property
    def command(self) -> str:
        """What makes the lock fit again."""
        return f"'crowdbot lock {self.spec}'"


def lock_paths(document: Path) -> tuple[Path, Path]:
    """The lock and the agents beside a document."""
    return document.with_suffix(".lock.json"), document.with_suffix(".agents.csv")


def parse_lock(text: str, name: str, spec: str) -> Lock:
    """A lock from its text.

    Raises:
        InputError: it is not a lock, or a newer release wrote it.
    """
    again = f"restore it, or delete it and run 'crowdbot lock {spec}'"
    try:
        content = json.loads(text)
        version = content.get("lock") if isinstance(content, dict) else None
        if isinstance(version, int) and version > LOCK:
            raise InputError(
                f"{name} has lock format {version}, written by crowdbot "
                f"{content.get('crowdbot')}; this release reads format {LOCK}: upgrade crowdbot"
            )
        return Lock.model_validate(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(str(p) for p in first["loc"])
        raise InputError(f"{name} is not a lock: {place}: {first['msg']}; {again}") from None
    except (ValueError, RecursionError) as error:
        raise InputError(f"{name} is not a lock: {error}; {again}") from None


#: The last column that every table of agents has.
LAST_COLUMN = "goal_key"


def split_tables(text: str, name: str) -> dict[str, str]:
    """Name -> table as text, taken from the file of all tables; "" -> a table of nobody.

    Raises:
        InputError: the text is not such a file.
    """
    try:
        rows = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    except csv.Error as error:
        raise InputError(f"{name} is not a table of agents: {error}") from None
    if not rows or rows[0][:1] != ["draw"] or not all(rows):
        raise InputError(f"{name} is not a table of agents: its first column must be 'draw'")
    grouped: dict[str, list[list[str]]] = {"": [rows[0][1:]]}
    for row in rows[1:]:
        grouped.setdefault(row[0], [rows[0][1:]]).append(row[1:])
    return {key: _to_csv(_used_columns(table)) for key, table in grouped.items()}


def _is_plain(text: str) -> bool:
    """Whether a text without quotes, as `join_tables` writes it, can only be a file of tables."""
    if '"' in text or "\r" in text or "\0" in text or not text.startswith("draw,"):
        return False
    lines = text.removesuffix("\n").split("\n")
    return all(lines) and max(map(len, lines)) < csv.field_size_limit()


def join_tables(tables: Mapping[str, str]) -> str:
    """The file of all tables; tables without agents have no rows in it.

    Columns that only some tables have stand after `LAST_COLUMN`, and are empty for the others.
    """
    read = {name: list(csv.reader(io.StringIO(t, newline=""))) for name, t in tables.items()}
    header = list(dict.fromkeys(column for rows in read.values() for column in rows[0]))
    if LAST_COLUMN in header:  # those that not all have: always in the same order
        end = header.index(LAST_COLUMN) + 1
        header = header[:end] + sorted(header[end:])
    lines = [["draw", *header]]
    for name, (own, *rows) in read.items():
        place = {column: i for i, column in enumerate(own)}
        lines += [[name, *(row[place[c]] if c in place else "" for c in header)] for row in rows]
    return _to_csv(lines)


def _used_columns(table: list[list[str]]) -> list[list[str]]:
    """A table without the columns after `LAST_COLUMN` in which it has nothing."""
    header, *rows = table
    if LAST_COLUMN not in header:
        return table
    end, width = header.index(LAST_COLUMN), len(header)
    if any(len(row) != width for row in rows):
        return table  # whoever reads it says what is wrong
    kept = [i for i in range(width) if i <= end or any(row[i] for row in rows)]
    return [[row[i] for i in kept] for row in table]


def table_hash(table: str) -> str:
    """The realisation hash of a table as text."""
    return f"cb1-sha256:{hashlib.sha256(table.encode()).hexdigest()}"


def split_values(all_values: Mapping[str, Values]) -> tuple[Values, dict[str, Values]]:
    """Fields that are equal in all scenarios, and the others of each."""
    listed = list(all_values.values())
    first = listed[0] if listed else {}
    common = {
        path: value
        for path, value in first.items()
        if all(path in v and _same(v[path], value) for v in listed)
    }
    rest = {
        id_: {path: value for path, value in values.items() if path not in common}
        for id_, values in all_values.items()
    }
    return common, rest


def flatten(content: Any, path: str = "") -> Values:
    """A document as dotted path -> value; empty maps count as values."""
    if not isinstance(content, dict) or (path and not content):
        return {path: content}
    found: Values = {}
    for key, value in content.items():
        found |= flatten(value, f"{path}.{key}" if path else key)
    return found


def changes(old: Values, new: Values) -> Iterator[str]:
    """What changed between two scenarios, field by field, for people."""
    for path in sorted({*old, *new}):
        if path not in old:
            yield f"{path}: new, {json.dumps(new[path])}"
        elif path not in new:
            yield f"{path}: gone, was {json.dumps(old[path])}"
        elif not _same(old[path], new[path]):
            yield f"{path}: {json.dumps(old[path])} -> {json.dumps(new[path])}"


def _same(a: Any, b: Any) -> bool:
    return type(a) is type(b) and bool(a == b)


def _to_csv(rows: Iterable[list[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def _read(path: Path) -> str:
    try:
        return path.read_bytes().decode()
    except OSError as error:
        raise InputError(f"{path.name}: {(error.strerror or str(error)).lower()}") from None
    except UnicodeDecodeError:
        raise InputError(f"{path.name} is not UTF-8 text") from None
