"""Comparison of a lock with its suite: hashes and tables as text; nothing is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.identity.canonical import content_hash, plain
from crowdbot.dsl.identity.population_inputs import population_inputs
from crowdbot.dsl.scenario.field_hashes import Values, flatten
from crowdbot.dsl.scenario.lock import Lock, LockFiles
from crowdbot.dsl.scenario.scenario import OUTSIDE_HASH, Scenario
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True)
class LockDifference:
    """One difference between a suite and its lock.

    Attributes:
        what: ``added`` or ``removed`` (an id), ``changed`` (a scenario), ``order`` (of the ids),
            ``agents`` (a table), ``suite`` (its id).
        id: id of the scenario; name of the table for ``agents``.
        details: the changed fields, or the error.
    """

    what: str
    id: str
    details: tuple[str, ...] = ()

    def __str__(self) -> str:
        more = "".join(f"\n    {line}" for line in self.details)
        return f"{self.what} {self.id}{more}"

    def as_dict(self) -> dict[str, Any]:
        """Return a dictionary for ``--json``."""
        return asdict(self)


def spec_of(scenario: Scenario, registry: Registry) -> str:
    """Return the hash of a scenario.

    Raises:
        InputError: its people are hidden, so it has none.
    """
    check_revealed(scenario)
    return content_hash(scenario, registry.spec_versions(scenario))


def check_revealed(scenario: Scenario) -> None:
    """Raise an error if the people of a scenario are still hidden.

    Raises:
        InputError: their seed is hidden; the message explains how to practise.
    """
    if scenario.hidden:
        raise InputError(
            f"{scenario.id}: its people are hidden, the seed of {scenario.hidden[:19]}… has not "
            "been revealed yet; to practise on people of your own: --set crowd.seed.root=1"
        )


def values_of(scenario: Scenario) -> Values:
    """Return the hashed fields of a scenario, by dotted path."""
    return flatten({k: v for k, v in plain(scenario).items() if k not in OUTSIDE_HASH})


def check_fits(files: LockFiles, scenario: Scenario, registry: Registry) -> None:
    """Check that one scenario is still the one that was locked.

    Raises:
        InputError: it changed; the message lists the changes, and names ``crowdbot lock``.
    """
    lock, name = files.lock, files.lock_path.name
    advice = f"run {files.command} ('--check' lists what changed)"
    if scenario.id not in lock.scenarios:
        raise InputError(f"{name} has no scenario {scenario.id}: the suite changed; {advice}")
    if found := _changed(lock, scenario, registry):
        some = "; ".join(found[:3]) + ("; …" if len(found) > 3 else "")
        raise InputError(f"{name} does not fit {scenario.id} any more ({some}); {advice}")


def differences(expansion: Expansion, files: LockFiles, registry: Registry) -> list[LockDifference]:
    """Return all differences between a suite and its lock.

    Raises:
        InputError: the lock cannot be read.
    """
    lock = files.lock
    found = list(_of_scenarios(expansion, lock, registry))
    if lock.suite != expansion.suite_id:
        found.insert(0, LockDifference("suite", expansion.suite_id, (f"locked as {lock.suite}",)))
    found += _of_tables(files)
    return found or list(_of_needed_tables(expansion, lock))


def _of_scenarios(expansion: Expansion, lock: Lock, registry: Registry) -> Iterator[LockDifference]:
    ids = [s.id for s in expansion.scenarios]
    for scenario in expansion.scenarios:
        if scenario.id not in lock.scenarios:
            yield LockDifference("added", scenario.id)
        elif changed := _changed(lock, scenario, registry):
            yield LockDifference("changed", scenario.id, tuple(changed))
    for id_ in lock.scenarios:
        if id_ not in set(ids):
            yield LockDifference("removed", id_)
    if sorted(ids) == sorted(lock.scenarios) and ids != list(lock.scenarios):
        yield LockDifference("order", "of the ids")


def _changed(lock: Lock, scenario: Scenario, registry: Registry) -> list[str]:
    """Return what changed in a scenario, in words; nothing if its hash is the locked one."""
    locked, spec = lock.scenarios[scenario.id], spec_of(scenario, registry)
    if spec == locked.spec:
        return []
    found = lock.changes(scenario.id, values_of(scenario))
    found += [
        f"version of '{kind}': {lock.kinds.get(kind)} -> {version}"
        for kind, version in registry.spec_versions(scenario).items()
        if lock.kinds.get(kind) != version
    ]
    return found or [f"spec: {locked.spec} -> {spec}"]


def _of_tables(files: LockFiles) -> Iterator[LockDifference]:
    """Yield tables that differ from the lock, and inconsistent entries of the lock."""
    lock = files.lock
    for name in lock.draws:
        try:
            files.table(name)
        except InputError as error:
            yield LockDifference("agents", name, (str(error),))
    for name in sorted(files.tables.keys() - lock.draws.keys() - {""}):
        yield LockDifference(
            "agents", name, (f"{files.agents_path.name} has a table that is not used",)
        )
    for id_, locked in lock.scenarios.items():
        table = lock.draws.get(locked.draw) if locked.draw else None
        if locked.draw and (table is None or table.realisation != locked.realisation):
            yield LockDifference(
                "agents", id_, (f"its realisation is not that of '{locked.draw}'",)
            )


def _of_needed_tables(expansion: Expansion, lock: Lock) -> Iterator[LockDifference]:
    """Yield missing or unneeded tables; used if everything else matches."""
    needed = set()
    for scenario in expansion.scenarios:
        for name, one in [("", scenario), *scenario.references.items()]:
            inputs = population_inputs(one) if one.crowd is not None else None
            if inputs is None or inputs in needed:
                continue
            needed.add(inputs)
            if lock.table_of(inputs) is None:
                owner = f"reference '{name}'" if name else "the scenario"
                yield LockDifference("agents", scenario.id, (f"no table for {owner}",))
    for name, table in lock.draws.items():
        if table.inputs not in needed:
            yield LockDifference("agents", name, ("no scenario needs this table",))
