"""A lock: the scenarios of a suite with their hashes, and the agents that were drawn for them.

It stands beside ``NAME.yaml``: ``NAME.lock.json`` (`Lock`), and the tables of agents in
``NAME.agents.csv`` or in that file of a suite that this one extends. Text only: nothing is drawn
here, and no table is turned into numbers.
"""

from __future__ import annotations

import json
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

from annotated_types import Ge
from pydantic import Field, ValidationError, model_validator

from crowdbot.dsl.scenario.agent_tables import is_plain, split_tables, table_hash
from crowdbot.dsl.scenario.field_hashes import Values, changed_fields
from crowdbot.dsl.spec.spec import Spec
from crowdbot.dsl.text.bounded_files import read_bytes
from crowdbot.errors import InputError

#: Largest lock, or table of agents, bytes.
_LARGEST = 256_000_000
#: Version of the lock format of this release.
LOCK = 2


class LockedTable(Spec):
    """Hashes of a table of agents and of its inputs."""

    inputs: str = Field(description="Hash of everything that the drawing depends on.")
    realisation: str = Field(description="Hash of the table.")


class LockedScenario(Spec):
    """The frozen hashes of one scenario."""

    spec: str = Field(description="Hash of the scenario.")
    realisation: str = Field(description="Hash of its agents.")
    draw: str | None = Field(description="Name of its table; null: no people.")
    varied: list[str] = Field(description="Hash of its fields at each of 'places'.")


class Lock(Spec):
    """The content of ``NAME.lock.json``: labels and hashes, by which changes can be named."""

    lock: Annotated[int, Ge(1)] = Field(description="Version of this file's format.")
    crowdbot: str = Field(description="Version of crowdbot that wrote it.")
    suite: str = Field(description="Id of the suite.")
    agents: Annotated[str, Field(pattern=r"^[^/\\]+\.agents\.csv$")] | None = Field(
        description="The suite's file with the same tables that it shares; null: its own."
    )
    kinds: dict[str, int] = Field(description="Kind -> spec_version of all components.")
    common: dict[str, str] = Field(description="Hashes of fields that are equal in all scenarios.")
    places: list[str] = Field(description="Places of the fields in which scenarios differ.")
    draws: dict[str, LockedTable] = Field(description="The tables, by name.")
    scenarios: dict[str, LockedScenario] = Field(description="By id, in the suite's order.")

    @model_validator(mode="after")
    def _one_hash_for_each_place(self) -> Lock:
        for name, scenario in self.scenarios.items():
            if len(scenario.varied) != len(self.places):
                raise ValueError(f"{name}: {len(self.places)} hashes of 'varied' are needed")
        return self

    def table_of(self, inputs: str) -> str | None:
        """Return the name of the table that was drawn from these inputs."""
        return self._by_inputs.get(inputs)

    @cached_property
    def _by_inputs(self) -> dict[str, str]:
        return {table.inputs: name for name, table in self.draws.items()}

    def changes(self, id_: str, values: Values) -> list[str]:
        """Return the changes in one scenario since it was locked, in words."""
        return list(changed_fields(self.common, self.places, self.scenarios[id_].varied, values))

    def text(self) -> str:
        """Return the file's JSON text, one line per scenario, table and common field."""
        parts = []
        for name, value in self.model_dump(mode="json").items():
            if isinstance(value, dict) and value:
                rows = ",\n".join(f"  {json.dumps(k)}: {json.dumps(v)}" for k, v in value.items())
                parts.append(f"{json.dumps(name)}: {{\n{rows}\n}}")
            else:
                parts.append(f"{json.dumps(name)}: {json.dumps(value)}")
        return "{\n" + ",\n".join(parts) + "\n}\n"


class LockFiles:
    """The two files of a lock, each read when it is needed.

    Args:
        document: the suite file beside them.
        spec: the user's name of the suite, for messages.
    """

    def __init__(self, document: Path, spec: str) -> None:
        self._document = document
        self.lock_path = document.with_suffix(".lock.json")
        #: File of tables that no other suite has.
        self.own_agents_path = document.with_suffix(".agents.csv")
        self.spec = spec

    def __deepcopy__(self, memo: object) -> LockFiles:
        return self

    def __reduce__(self) -> tuple[type[LockFiles], tuple[Path, str]]:
        """Pickle the paths only: another process reads the files itself."""
        return LockFiles, (self._document.absolute(), self.spec)

    @cached_property
    def lock(self) -> Lock:
        """Return the lock.

        Raises:
            InputError: there is none, it is not a lock, or it has another format version.
        """
        return parse_lock(_read(self.lock_path), self.lock_path.name, self.spec)

    @cached_property
    def draws(self) -> dict[str, LockedTable]:
        """Return the tables by name, also of a lock of an older format.

        Raises:
            InputError: there is no lock, or it is not one.
        """
        try:
            content = json.loads(_read(self.lock_path))
            if content["lock"] < LOCK:
                return {n: LockedTable.model_validate(t) for n, t in content["draws"].items()}
        except (ValueError, RecursionError, KeyError, TypeError, AttributeError):
            pass  # `lock` says what is wrong
        return self.lock.draws

    @property
    def agents_path(self) -> Path:
        """Return the file of the tables: the suite's own, or the shared one."""
        try:
            shared = self.lock.agents
        except InputError:
            shared = None
        return self.lock_path.with_name(shared) if shared else self.own_agents_path

    @cached_property
    def tables(self) -> dict[str, str]:
        """Return name -> table as text; "" -> an empty table.

        Raises:
            InputError: the file is missing or invalid.
        """
        return split_tables(_read(self.agents_path), self.agents_path.name)

    def check_tables(self) -> None:
        """Check that the file of the tables is valid, without splitting it if possible.

        Raises:
            InputError: as in `tables`.
        """
        if "tables" not in self.__dict__ and not is_plain(_read(self.agents_path)):
            _ = self.tables

    def table(self, name: str) -> str:
        """Return one table as text; its hash is the one of the lock.

        Raises:
            InputError: it is missing or was changed.
        """
        text = self.tables.get(name, self.tables[""])
        if table_hash(text) != self.draws[name].realisation:
            problem = "was changed" if name in self.tables else "is missing"
            raise InputError(
                f"{self.agents_path.name}: table '{name}' {problem} since {self.lock_path.name} "
                f"was written; restore the file, or run {self.command}"
            )
        return text

    @property
    def command(self) -> str:
        """Return the command that renews the lock, in quotes, for messages."""
        return f"'crowdbot lock {self.spec}'"


def parse_lock(text: str, name: str, spec: str) -> Lock:
    """Return a lock from its text.

    Raises:
        InputError: it is not a lock, or it has the format of another release.
    """
    again = f"restore it, or delete it and run 'crowdbot lock {spec}'"
    try:
        content = json.loads(text)
        if isinstance(content, dict):
            _check_format(content, name, spec)
        return Lock.model_validate(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(str(p) for p in first["loc"])
        raise InputError(f"{name} is not a lock: {place}: {first['msg']}; {again}") from None
    except (ValueError, RecursionError) as error:
        raise InputError(f"{name} is not a lock: {error}; {again}") from None


def _check_format(content: dict[str, Any], name: str, spec: str) -> None:
    version, writer = content.get("lock"), content.get("crowdbot")
    if not isinstance(version, int) or writer is None or version == LOCK:
        return
    advice = "upgrade crowdbot"
    if version < LOCK:
        advice = f"renew it with 'crowdbot lock {spec}', which keeps the agents"
    raise InputError(
        f"{name} has lock format {version}, written by crowdbot {writer}; this release reads "
        f"format {LOCK}: {advice}"
    )


def _read(path: Path) -> str:
    try:
        return read_bytes(path, _LARGEST).decode()
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise InputError(f"{path.name}: {why}") from None
    except UnicodeDecodeError:
        raise InputError(f"{path.name} is not UTF-8 text") from None
