"""The request for a campaign, with opened and checked suites and planners."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from crowdbot.core.campaign.job import SuiteSource
from crowdbot.core.planning.fleet_choice import planners_by_robot
from crowdbot.core.planning.resolve import PlannerChoice, kinds_of_role, resolve_planner
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.run_options import USUAL, RunOptions
from crowdbot.core.scenarios.library import open_spec, select_any
from crowdbot.core.scenarios.with_crowds import with_crowds
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.spec.component_specs import PlannerRole
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError, UnknownNameError, UsageError


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignRequest:
    """The request for a campaign, as written by the user.

    Attributes:
        suites: paths or names of packaged suites.
        seeds: seeds of the runs; None: those of each suite, else 0.
        roles: also run planners with these roles, if the robot has their sensors.
        floors: also run floors and ceilings, in a sample of the scenarios and with the first seed,
            if the robot has their sensors.
        only: patterns of scenario ids, each of which must match a scenario of some suite; none:
            all scenarios.
        sample: number of randomly chosen scenarios per suite; None: all.
        planner_settings: ``key=value`` texts, for all planners.
        crowds: names of crowds, in each of which every scenario is run; none: in its own.
        options: run options; ``force`` also repeats calibration runs.
    """

    suites: Sequence[str]
    planners: Sequence[str]
    seeds: Sequence[int] | None = None
    roles: Sequence[PlannerRole] = ()
    floors: bool = False
    only: Sequence[str] = ()
    sample: int | None = None
    out: Path = Path("runs")
    options: RunOptions = USUAL
    overrides: Sequence[str] = ()
    planner_settings: Sequence[str] = ()
    plugins: Sequence[Path] = ()
    crowds: Sequence[str] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class SelectedSuite:
    """An opened suite, and its selected scenarios."""

    source: SuiteSource
    expansion: Expansion
    scenarios: Sequence[Scenario]

    @property
    def name(self) -> str:
        """Return the folder of its runs."""
        return self.expansion.suite


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannerEntry:
    """A planner of the campaign: the text with which a worker finds it, and its choice.

    Attributes:
        settings: ``key=value`` texts.
        optional: skipped in scenarios whose robot lacks its sensors.
        sampled: run in a sample of the scenarios, with the first seed.
    """

    text: str
    choice: PlannerChoice
    settings: tuple[str, ...] = ()
    optional: bool = False
    sampled: bool = False


def open_suites(request: CampaignRequest, registry: Registry) -> list[SelectedSuite]:
    """Return all suites of a campaign.

    Raises:
        SpecError: a document is wrong.
        UnknownNameError: no such suite, or the pattern matches no scenario.
        InputError: two suites have the same id.
    """
    suites, unmatched = list[SelectedSuite](), set(request.only)
    plugins = tuple(str(p.resolve()) for p in request.plugins)
    crowds = tuple(dict.fromkeys(_absolute(c) for c in request.crowds))
    for spec in dict.fromkeys(request.suites):
        expansion = open_spec(spec, registry, request.overrides)
        expansion = with_crowds(expansion, crowds, registry)
        source = SuiteSource(
            spec=_absolute(spec),
            overrides=tuple(request.overrides),
            plugins=plugins,
            allowed=registry.allowed,
            crowds=crowds,
        )
        chosen, missed = select_any(expansion, request.only)
        unmatched &= set(missed)
        suites.append(SelectedSuite(source=source, expansion=expansion, scenarios=chosen))
    _check_folders(suites)
    if unmatched:
        known = [s.id for suite in suites for s in suite.expansion.scenarios]
        raise UnknownNameError("scenario", min(unmatched, key=request.only.index), known)
    return suites


def open_planners(request: CampaignRequest, registry: Registry) -> list[PlannerEntry]:
    """Return all planners of a campaign.

    Raises:
        UsageError: no planner is named.
        InputError: a planner is invalid, or two would share folders.
        PlannerError: a Python file cannot be imported.
    """
    if not request.planners and not request.roles:
        raise UsageError("which planner? Give --planner NAME, once for each")
    settings = tuple(request.planner_settings)
    entries = [
        PlannerEntry(
            text=_planner(p),
            choice=resolve_planner(p, registry, settings, request.options.place),
            settings=settings,
        )
        for p in dict.fromkeys(request.planners)
    ]
    for entry in _by_role(request, registry):
        if entry.choice.label not in [e.choice.label for e in entries]:
            entries.append(entry)
    labels: dict[str, PlannerEntry] = {}
    for entry in entries:
        other = labels.setdefault(entry.choice.label, entry)
        if other is not entry:
            raise InputError(
                f"'{other.text}' and '{entry.text}' are both called {entry.choice.label}: "
                "their runs would replace each other; give each a folder with --out"
            )
    return entries


def _by_role(request: CampaignRequest, registry: Registry) -> list[PlannerEntry]:
    """Return planners added by role, then floors and ceilings."""
    sampled: tuple[PlannerRole, ...] = ("floor", "ceiling") if request.floors else ()
    found = []
    for role in (*request.roles, *(r for r in sampled if r not in request.roles)):
        for kind in kinds_of_role(role, registry):
            choice = resolve_planner(kind, registry, place=request.options.place)
            is_sampled = role not in request.roles
            found.append(PlannerEntry(text=kind, choice=choice, optional=True, sampled=is_sampled))
    return found


def _check_folders(suites: Sequence[SelectedSuite]) -> None:
    taken: dict[tuple[str, str], SelectedSuite] = {}
    for suite in suites:
        for scenario in suite.scenarios:
            other = taken.setdefault((suite.name, scenario.id), suite)
            if other is not suite:
                raise InputError(
                    f"{other.source.spec} and {suite.source.spec} both have "
                    f"{suite.name}/{scenario.id}: their runs would replace each other"
                )


def _absolute(spec: str) -> str:
    """Return a file as absolute path, valid in any working directory; other names unchanged."""
    return str(Path(spec).resolve()) if Path(spec).is_file() else spec


def _planner(text: str) -> str:
    """Return a planner with absolute file names, valid in other working directories."""
    by_robot = planners_by_robot(text)
    if by_robot:
        return ",".join(f"{robot}={_planner(planner)}" for robot, planner in by_robot.items())
    path, colon, name = text.rpartition(":")
    if colon and path.endswith(".py"):
        return f"{Path(path).resolve()}:{name}"
    return str(Path(text).resolve()) if text.endswith((".yaml", ".yml")) or "/" in text else text
