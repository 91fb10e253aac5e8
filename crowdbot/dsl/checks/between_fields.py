"""Checks across several fields, after a scenario is validated."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from crowdbot.dsl.checks.agents import check_agents
from crowdbot.dsl.checks.crowd import check_crowd
from crowdbot.dsl.checks.facts import Facts
from crowdbot.dsl.checks.paths import check_paths, check_place
from crowdbot.dsl.checks.person_goals import check_person_goals
from crowdbot.dsl.checks.pydantic_errors import locate, missing_field
from crowdbot.dsl.checks.robots import check_descriptions, check_robots, check_tasks
from crowdbot.dsl.checks.spawns import check_spawns
from crowdbot.dsl.checks.streams import check_streams
from crowdbot.dsl.scenario.components import components
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.dsl.text.nodes import Node

Check = Callable[[Facts], Iterator[Diagnostic]]


class Checks:
    """The checks of a document's scenarios; parts that passed are not checked again.

    Each check declares the parts of a scenario that it depends on. A part is identified by its
    node, which scenarios share if no axis changes it; the caller keeps the nodes alive.
    """

    def __init__(self) -> None:
        self._passed: set[tuple[object, ...]] = set()

    def of(self, scenario: Scenario, tree: Node) -> list[Diagnostic]:
        """Return the errors between fields of a scenario, with positions in its source tree."""
        diagnostics, facts = list[Diagnostic](), Facts(scenario, tree)
        for check, parts in _CHECKS:
            key = (check, *(id(tree.child(part)) for part in parts))
            if key not in self._passed:
                wrong = list(check(facts))
                diagnostics += wrong
                if not wrong:
                    self._passed.add(key)
        return diagnostics


def _check_kinds(part: str, facts: Facts) -> Iterator[Diagnostic]:
    """Require explicit kinds: a default would change with the installation."""
    tree = facts.tree
    for path, _ in components(facts.scenario):
        if path[0] != part or _has_kind(tree, path):
            continue
        place = locate(tree, path)
        if not place.rest and place.node.child("kind") is None:
            yield missing_field(tree, place, "kind")


def _has_kind(tree: Node, path: tuple[str, ...]) -> bool:
    """Return True if the document writes a ``kind`` in the map at a path."""
    node: Node | None = tree
    for name in (*path, "kind"):
        node = None if node is None else node.child(name)
    return node is not None


def _of_crowd(check: Check) -> Check:
    """Return a check that passes scenarios without people, and applies ``check`` to all others."""
    return lambda facts: check(facts) if facts.scenario.crowd is not None else iter(())


_PLACE, _PEOPLE, _ROBOTS = ("environment",), ("environment", "crowd"), ("environment", "robots")
#: Each check, with the parts of a scenario that it uses.
_CHECKS: tuple[tuple[Check, tuple[str, ...]], ...] = (
    *((partial(_check_kinds, part), (part,)) for part in ("environment", "crowd", "robots")),
    (_of_crowd(check_crowd), _PEOPLE),
    (_of_crowd(check_streams), _PEOPLE),
    (_of_crowd(check_spawns), _PEOPLE),
    (_of_crowd(check_agents), (*_PEOPLE, "robots")),
    (check_place, _PLACE),
    (check_robots, _ROBOTS),
    (check_descriptions, ("robots",)),
    (_of_crowd(check_paths), _PEOPLE),
    (check_tasks, _ROBOTS),
    (check_person_goals, (*_PEOPLE, "robots")),
)
