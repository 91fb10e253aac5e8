"""Locks with their tables: the agents of a suite are drawn once, then read."""

from __future__ import annotations

import itertools
import os
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from importlib import metadata
from pathlib import Path, PurePath
from typing import Literal

from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.lock_check import check_fits, check_revealed, spec_of, values_of
from crowdbot.dsl.identity.population_inputs import population_inputs
from crowdbot.dsl.scenario.agent_tables import join_tables, table_hash
from crowdbot.dsl.scenario.field_hashes import FieldHashes, hash_fields
from crowdbot.dsl.scenario.lock import LOCK, Lock, LockedScenario, LockedTable, LockFiles
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.text.diagnostics import Mark
from crowdbot.dsl.text.nodes import Node
from crowdbot.errors import InputError

_NAME = re.compile(r"[A-Za-z0-9_.+-]+")


@dataclass(frozen=True)
class Population:
    """The agents of a scenario, and True if they were read from a lock."""

    agents: Realisation
    source: Literal["locked", "drawn", "none"]

    @cached_property
    def hash(self) -> str:
        """Return the content hash of the agents, which scenarios and runs share unchanged."""
        return self.agents.hash


def _check_draw(files: LockFiles, scenario: Scenario, origin: Scenario, name: str | None) -> None:
    """Check that the people of a scenario are those that the lock names for it.

    Raises:
        InputError: the lock was edited.
    """
    locked = files.lock.scenarios[origin.id]
    if population_inputs(scenario) != population_inputs(origin) or locked.draw is None:
        return  # changed with --set, or a calibration run with its own people
    found = files.lock.draws[name].realisation if name is not None else "none"
    if name != locked.draw or found != locked.realisation:
        raise InputError(
            f"{files.lock_path.name}: the realisation of {origin.id} is {locked.realisation[:30]}, "
            f"that of its table '{locked.draw}' is {found[:30]}: the lock was edited; restore it, "
            f"or run {files.command}"
        )


@dataclass(frozen=True, slots=True)
class NewLock:
    """A new lock, its tables by name, and the number of newly sampled tables."""

    lock: Lock
    tables: Mapping[str, str]
    drawn: int

    def agents_path(self, files: LockFiles) -> Path:
        """Return the file of the tables: the suite's own, or the one that it shares."""
        shared = self.lock.agents
        return files.lock_path.with_name(shared) if shared else files.own_agents_path


def population(scenario: Scenario, registry: Registry) -> Population:
    """Return a scenario's agents from its suite's lock, sampled only if there is none.

    Agents are also sampled if ``--set`` or Python code changed an input of the sampling.

    Raises:
        InputError: the lock is out of date, or the seed of the agents is hidden.
    """
    if scenario.crowd is None:
        return Population(Realisation.nobody(), "none")
    check_revealed(scenario)
    if scenario.locked is None:
        return Population(_drawn(scenario, registry), "drawn")
    files = scenario.locked.files
    check_fits(files, scenario.locked.origin(), registry)
    name = files.lock.table_of(population_inputs(scenario))
    _check_draw(files, scenario, scenario.locked.origin(), name)
    if name is None:
        return Population(_drawn(scenario, registry), "drawn")
    text = files.table(name)
    try:
        return Population(Realisation.from_csv(text), "locked")
    except InputError as error:
        raise InputError(
            f"{files.agents_path.name}: table '{name}': {error}; run {files.command}"
        ) from None


def make_lock(
    expansion: Expansion, registry: Registry, files: LockFiles, *, redraw: bool = False
) -> NewLock:
    """Freeze a suite; tables whose inputs did not change are kept as they are.

    Args:
        expansion: of the suite.
        registry: the installed components.
        files: of its lock, which need not exist.
        redraw: keep no table.

    Raises:
        InputError: a crowd cannot be sampled or is hidden, or the old lock is not a lock.
    """
    for scenario in expansion.scenarios:
        check_revealed(scenario)
    old = files if files.lock_path.exists() and not redraw else None
    locked, drawn = dict[str, LockedTable](), 0
    tables, by_inputs = dict[str, str](), dict[str, str]()
    for scenario in _with_crowd(expansion):
        inputs = population_inputs(scenario)
        if inputs in by_inputs:
            continue
        kept = _kept(old, inputs)
        table = _drawn(scenario, registry).to_csv() if kept is None else kept
        drawn += kept is None
        name = _free_name(scenario, expansion.suite_id, locked)
        by_inputs[inputs], tables[name] = name, table
        locked[name] = LockedTable(inputs=inputs, realisation=table_hash(table))
    fields = hash_fields({s.id: values_of(s) for s in expansion.scenarios})
    scenarios = _scenarios(expansion, registry, by_inputs, locked, fields)
    kinds = {k: v for s in expansion.scenarios for k, v in registry.spec_versions(s).items()}
    lock = Lock(
        lock=LOCK,
        crowdbot=metadata.version("crowdbot"),
        suite=expansion.suite_id,
        agents=_shared_file(expansion, files, join_tables(tables)),
        kinds=dict(sorted(kinds.items())),
        common=fields.common,
        places=list(fields.places),
        draws=locked,
        scenarios=scenarios,
    )
    return NewLock(lock, tables, drawn)


def write_lock(files: LockFiles, made: NewLock) -> None:
    """Write both files atomically: both or neither.

    A file of tables that is shared with another suite is left alone.

    Raises:
        InputError: the folder cannot be written to.
    """
    texts = {files.lock_path: made.lock.text()}
    if made.lock.agents is None:
        texts = {files.own_agents_path: join_tables(made.tables), **texts}
    parts = {path: path.with_name(f".{path.name}.{os.getpid()}.part") for path in texts}
    before = {path: path.read_bytes() if path.exists() else None for path in texts}
    try:
        for path, part in parts.items():
            _write(part, texts[path].encode())
        try:
            for path, part in parts.items():
                part.replace(path)
        except OSError:
            _restore(before)
            raise
    except OSError as error:
        folder, why = files.lock_path.parent, error.strerror or error
        raise InputError(
            f"the lock cannot be written into {folder}: {str(why).lower()}; copy the suite into a "
            "folder of your own and lock it there"
        ) from error
    finally:
        for part in parts.values():
            part.unlink(missing_ok=True)
    if made.lock.agents is not None:
        files.own_agents_path.unlink(missing_ok=True)


def _shared_file(expansion: Expansion, files: LockFiles, text: str) -> str | None:
    """Return the name of a file with the same tables, of a suite that this one extends."""
    tree = next(iter(expansion.trees.values()), None)
    for source in sorted({mark.source.name for mark in _marks(tree)}) if tree else ():
        path = files.lock_path.with_name(PurePath(source.rpartition(":")[2]).name)
        other = path.with_suffix(".agents.csv")
        if other == files.own_agents_path or not other.is_file():
            continue
        if other.read_bytes() == text.encode():
            return other.name
    return None


def _marks(node: Node) -> Iterator[Mark]:
    """Yield the position in its file of each value of a tree."""
    yield node.mark
    for entry in node.entries.values():
        yield from _marks(entry.node)


def _drawn(scenario: Scenario, registry: Registry) -> Realisation:
    return realise(scenario, build_environment(registry, scenario.environment))


def _kept(old: LockFiles | None, inputs: str) -> str | None:
    """Return the table that was drawn from these inputs before, if it is whole and up to date."""
    if old is None:
        return None
    name = next((n for n, table in old.draws.items() if table.inputs == inputs), None)
    if name is None:
        return None
    try:
        table = old.table(name)
        Realisation.from_csv(table)
    except InputError:  # edited by hand, or written by a release with other columns
        return None
    return table


def _with_crowd(expansion: Expansion) -> Iterator[Scenario]:
    for scenario in expansion.scenarios:
        for one in (scenario, *scenario.references.values()):
            if one.crowd is not None:
                yield one


def _free_name(scenario: Scenario, suite: str, taken: Mapping[str, object]) -> str:
    """Return a table's name: the crowd's seed key or the suite, numbered if that is taken."""
    assert scenario.crowd is not None
    key = scenario.crowd.seed.key
    name = key if _NAME.fullmatch(key) else suite
    numbered = (f"{name}~{number}" for number in itertools.count(2))
    return name if name not in taken else next(n for n in numbered if n not in taken)


def _scenarios(
    expansion: Expansion,
    registry: Registry,
    by_inputs: Mapping[str, str],
    locked: Mapping[str, LockedTable],
    fields: FieldHashes,
) -> dict[str, LockedScenario]:
    scenarios = {}
    for scenario in expansion.scenarios:
        name = by_inputs[population_inputs(scenario)] if scenario.crowd is not None else None
        scenarios[scenario.id] = LockedScenario(
            spec=spec_of(scenario, registry),
            realisation=locked[name].realisation if name else Realisation.nobody().hash,
            draw=name,
            varied=list(fields.varied[scenario.id]),
        )
    return scenarios


def _write(path: Path, content: bytes) -> None:
    with path.open("wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


def _restore(before: Mapping[Path, bytes | None]) -> None:
    with suppress(OSError):
        for path, content in before.items():
            if content is None:
                path.unlink(missing_ok=True)
            else:
                path.write_bytes(content)
