"""Pictures of a suite's conditions, drawn from above."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from crowdbot.core.population.realisation import Realisation
from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.lock import population
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.view.build import build_map_content
from crowdbot.core.view.facts import scenario_facts
from crowdbot.core.view.map_content import MapContent
from crowdbot.core.view.render import render
from crowdbot.core.view.svg import to_svg
from crowdbot.dsl.identity.canonical import content_hash
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.suite.matrix import DRAW

FOLDER = "scenarios"


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """One condition of a suite.

    Attributes:
        scenario: id of the scenario that is drawn, the first draw of the condition.
        words: the condition in words: quantity and value of each axis.
        draws: number of its scenarios.
        file: picture, relative to the site; without people while the draws are hidden.
        small: the same without its legend, for an overview.
    """

    scenario: str
    words: tuple[str, ...]
    draws: int
    file: str
    small: str


def draw_conditions(expansion: Expansion, registry: Registry, folder: Path) -> list[Picture]:
    """Draw the first scenario of each condition into ``scenarios/`` of a folder.

    Raises:
        InputError: a picture cannot be written.
    """
    groups: dict[tuple[tuple[str, str], ...], list[Scenario]] = {}
    for scenario in expansion.scenarios:
        labels = expansion.axes.get(scenario.id, {})
        condition = tuple((axis, label) for axis, label in labels.items() if axis != DRAW)
        groups.setdefault(condition or ((scenario.id, ""),), []).append(scenario)
    return [_draw(expansion, group, registry, folder) for group in groups.values()]


def _draw(expansion: Expansion, group: list[Scenario], registry: Registry, folder: Path) -> Picture:
    first = group[0]
    words = expansion.words_of(first.id)
    words_shown = tuple(f"{one.title}: {one.value}" for axis, one in words.items() if axis != DRAW)
    place = f"{FOLDER}/{first.id.replace('/', '_')}"
    picture = Picture(
        scenario=first.id, words=words_shown, draws=len(group), file=f"{place}.svg",
        small=f"{place}-small.svg",
    )  # fmt: skip
    (folder / FOLDER).mkdir(exist_ok=True)
    content, facts = _content(first, registry)
    for file, legend in ((picture.file, True), (picture.small, False)):
        drawing = render(content, first.id, facts, heading=False, legend=legend)
        atomic_write(folder / file, to_svg(drawing))
    return picture


def _content(scenario: Scenario, registry: Registry) -> tuple[MapContent, dict[str, str]]:
    """Return the map's content and facts; without people and facts while the draws are hidden."""
    if scenario.hidden:
        return build_map_content(scenario, Realisation.nobody(), registry), {}
    people = population(scenario, registry).agents
    spec = content_hash(scenario, registry.spec_versions(scenario))
    return build_map_content(scenario, people, registry), scenario_facts(scenario, people, spec)
