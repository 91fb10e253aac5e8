"""What a campaign is asked for, with every document and planner opened and checked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from crowdbot.core.library import open_spec, select
from crowdbot.core.planner_source import PlannerChoice, resolve_planner
from crowdbot.core.registry import Registry
from crowdbot.core.sim.campaign.job import Document
from crowdbot.core.sim.request import Recorded
from crowdbot.dsl.expand import Expansion
from crowdbot.dsl.scenario import Scenario
from crowdbot.errors import InputError, UnknownNameError, UsageError


@dataclass(frozen=True, slots=True, kw_only=True)
class Order:
    """What is wanted, as it was written.

    Attributes:
        suites: paths or names of packaged suites.
        only: pattern of scenario ids; must fit something in some suite.
        planner_settings: ``key=value`` texts, for all planners.
        retry_failed: run again what ended with a planner that failed.
    """

    suites: Sequence[str]
    planners: Sequence[str]
    seeds: Sequence[int] = (0,)
    only: str | None = None
    out: Path = Path("runs")
    record: Recorded = "used"
    replay: bool = True
    overrides: Sequence[str] = ()
    planner_settings: Sequence[str] = ()
    plugins: Sequence[Path] = ()
    retry_failed: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Suite:
    """An opened suite, and those of its scenarios that are wanted."""

    document: Document
    expansion: Expansion
    scenarios: Sequence[Scenario]

    @property
    def name(self) -> str:
        """The folder of its runs."""
        return "scenarios" if self.expansion.single else self.expansion.suite_id


@dataclass(frozen=True, slots=True, kw_only=True)
class Entrant:
    """A planner: how a worker finds it, and what it is."""

    text: str
    choice: PlannerChoice


def open_suites(order: Order, registry: Registry) -> list[Suite]:
    """All suites of a campaign.

    Raises:
        SpecError: a document is wrong.
        UnknownNameError: no such suite, or the pattern fits no scenario.
        InputError: two suites have the same id.
    """
    suites = []
    plugins = tuple(str(p.resolve()) for p in order.plugins)
    for spec in dict.fromkeys(order.suites):
        expansion = open_spec(spec, registry, order.overrides)
        document = Document(
            spec=_absolute(spec),
            overrides=tuple(order.overrides),
            plugins=plugins,
            allowed=registry.allowed,
        )
        chosen = expansion.scenarios if order.only is None else select(expansion, order.only)
        suites.append(Suite(document=document, expansion=expansion, scenarios=chosen))
    _check_folders(suites)
    if order.only is not None and not any(s.scenarios for s in suites):
        known = [s.id for suite in suites for s in suite.expansion.scenarios]
        raise UnknownNameError("scenario", order.only, known)
    return suites


def open_planners(order: Order, registry: Registry) -> list[Entrant]:
    """All planners of a campaign.

    Raises:
        UsageError: none is named.
        InputError: one is wrong, or two would write into the same folders.
        PlannerError: a Python file cannot be imported.
    """
    if not order.planners:
        raise UsageError("which planner? Give --planner NAME, once for each")
    entrants = [
        Entrant(text=_planner(p), choice=resolve_planner(p, registry, order.planner_settings))
        for p in dict.fromkeys(order.planners)
    ]
    labels: dict[str, Entrant] = {}
    for entrant in entrants:
        other = labels.setdefault(entrant.choice.label, entrant)
        if other is not entrant:
            raise InputError(
                f"'{other.text}' and '{entrant.text}' are both called {entrant.choice.label}: "
                "their runs would replace each other; give each a folder with --out"
            )
    return entrants


def _check_folders(suites: Sequence[Suite]) -> None:
    taken: dict[tuple[str, str], Suite] = {}
    for suite in suites:
        for scenario in suite.scenarios:
            other = taken.setdefault((suite.name, scenario.id), suite)
            if other is not suite:
                raise InputError(
                    f"{other.document.spec} and {suite.document.spec} both have "
                    f"{suite.name}/{scenario.id}: their runs would replace each other"
                )


def _absolute(spec: str) -> str:
    """A file may be opened from another working directory; a packaged suite has no path."""
    return str(Path(spec).resolve()) if Path(spec).is_file() else spec


def _planner(text: str) -> str:
    path, colon, name = text.rpartition(":")
    if colon and path.endswith(".py"):
        return f"{Path(path).resolve()}:{name}"
    return str(Path(text).resolve()) if text.endswith((".yaml", ".yml")) or "/" in text else text
