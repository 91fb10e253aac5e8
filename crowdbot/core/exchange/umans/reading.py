"""Files of UMANS together: simulation, agents, obstacles, policies and written trajectories."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from crowdbot.core.exchange.companions import companion
from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable, positive
from crowdbot.core.exchange.scene import Data, Draft, id_of
from crowdbot.core.exchange.umans.agents import AGENT, DEFAULTS, read_agents
from crowdbot.core.exchange.umans.obstacles import OBSTACLES, read_obstacles
from crowdbot.core.exchange.umans.policies import COSTS, POLICY, cost_table, read_policies
from crowdbot.core.exchange.umans.presets import preset
from crowdbot.dsl.text.diagnostics import Mark

_PARTS = ("Agents", "Policies", "Obstacles", "World", "Simulation")
SIMULATION = RowTable(
    "Simulation",
    (
        Row("@delta_time", "", "people decide at rates.crowd, 16 Hz, and move 128 times a second"),
        Row("@end_time", "", "people alone walk as long as simulate --duration says"),
    ),
)
WORLD = RowTable(
    "World",
    (
        Row("@type", "environment.border", read=lambda item: item.word("infinite", "toric")),
        Row("@width", "environment.area", read=positive),
        Row("@height", "environment.area", read=positive),
    ),
)
Policies = dict[int, tuple[Data, Item]]


@dataclass(slots=True)
class _Elements:
    """Elements of all files, by their names; each with the file that it is in.

    Attributes:
        named: roots of files that other files name.
    """

    elements: dict[str, list[tuple[Item, Path]]] = field(default_factory=dict)
    named: list[Item] = field(default_factory=list)

    def of(self, name: str) -> list[tuple[Item, Path]]:
        return self.elements.get(name, [])


def read(files: Sequence[OpenedScene], context: Context) -> list[Draft]:
    """Return one scene for each combination of an agents and a policies element.

    Raises:
        SpecError: E402, a part has an invalid value.
    """
    report, elements = context.report, _Elements()
    for file in files:
        for root in file.roots:
            _collect(root, file.path, elements, context)
    sets: list[tuple[Policies, Path | None]] = [
        (read_policies(item, report), path) for item, path in elements.of("Policies")
    ]
    crowds: list[tuple[Item | None, Path | None]] = [*elements.of("Agents")]
    scenes = []
    for agents, agents_path in crowds or [(None, None)]:
        for policies, policies_path in sets or [({}, None)]:
            scene = Draft()
            _world(elements, scene, report)
            for item, _ in elements.of("Obstacles"):
                read_obstacles(item, scene, report)
            if agents is not None:
                read_agents(agents, policies, scene, report)
            _name(scene, agents_path, policies_path if len(sets) > 1 or agents is None else None,
                  files)  # fmt: skip
            _people_if_none(scene, policies, report, files[0].top)
            scenes.append(scene)
    for root in elements.named:
        report.rest(root)
    return scenes


def _collect(item: Item, path: Path, elements: _Elements, context: Context) -> None:
    """Collect an element once, those within it and those of the files that it names."""
    if any(item is known for known, _ in elements.of(item.name)):
        return
    report, item.used = context.report, True
    named = item.find("@file")
    if named is not None:
        other = context.open(companion(named, path))
        report.carried(named, "(read)")
        for root in other.roots:
            if root.name != item.name:
                root.refuse(f"'{root.name}' where the file that names it expects '{item.name}'")
            elements.named.append(root)
            _collect(root, other.path, elements, context)
        return
    elements.elements.setdefault(item.name, []).append((item, path))
    if item.name == "Simulation":
        report.take(item, SIMULATION)
    if item.name in ("Simulation", "World"):
        for part in item.every(*_PARTS):
            if part.name == "Obstacles" and item.name == "Simulation":
                report.left_out(part, "UMANS itself ignores Obstacles beside World")
            else:
                _collect(part, path, elements, context)


def _world(elements: _Elements, scene: Draft, report: Report) -> None:
    for item, _ in elements.of("World")[-1:]:
        fields = report.take(item, WORLD)
        scene.origins["environment",] = item.mark
        if fields.get("border") == "toric":
            x = 0.5 * item.need("@width").number(1e-3)
            y = 0.5 * item.need("@height").number(1e-3)
            scene.environment |= {"border": "torus", "area": {"x": [-x, x], "y": [-y, y]}}


def _name(
    scene: Draft, agents: Path | None, policies: Path | None, files: Sequence[OpenedScene]
) -> None:
    named = [path.stem for path in (agents, policies) if path] or [files[0].path.stem]
    scene.id = id_of("-".join(named))
    scene.notes.append(f"Imported from UMANS: {', '.join(f.path.name for f in files)}.")
    scene.notes.append("x and y are those of UMANS.")


def _people_if_none(scene: Draft, policies: Policies, report: Report, at: Mark) -> None:
    """Add two people for each policy where the files have none, so that something is simulated."""
    if scene.agents:
        return
    x0, _, y0, y1 = scene.extent()
    for column, (used, name, mark) in enumerate(_used(policies, at)):
        policy = scene.policy(used, name, mark)
        for start, end in ((y0, y1 + 8.0), (y1 + 8.0, y0)):
            x = x0 - 2.0 - 3.0 * column + (0.1 if start < end else 0.0)
            row = {"x": x, "y": start, **DEFAULTS, "goals": [[x, end]], "policy": policy}
            scene.agent(row, mark, "not in the files, which have no people")
    report.added("crowd.agents", "two people for each policy, since the files have none", at)


def _used(policies: Policies, at: Mark) -> Iterator[tuple[Data, str, Mark]]:
    if not policies:
        yield preset(0), "preset_0", at
    for number, (used, item) in policies.items():
        yield used, f"policy_{number}", item.mark


UMANS = SceneFormat(
    "umans",
    "UMANS",
    lambda file: file.kind == "xml" and bool(file.tags & set(_PARTS)),
    read,
    (SIMULATION, WORLD, POLICY, *(cost_table(name) for name in COSTS), AGENT, OBSTACLES),
    "the time step",
)
