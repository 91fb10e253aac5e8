"""The page docs/developers/author_surface.md, made from the module that plugins import."""

from __future__ import annotations

import inspect
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, get_args, get_origin

from crowdbot import plugin
from crowdbot.dsl.spec.quantities import UNITS, Quantity
from crowdbot.lazy import stub_names
from crowdbot.plugin import for_crowds, for_environments, for_learning, for_metrics, for_sensors

#: Tools that few components need.
ROOMS = (for_metrics, for_sensors, for_crowds, for_environments, for_learning)
PAGE = Path(__file__).parent.parent / "docs" / "developers" / "author_surface.md"

_HEAD = """\
# What plugins import

<!-- Written by make generate: change the modules, not this page. -->

`crowdbot.plugin` holds all that a package of components needs: specs and components, which are
imported to list and to validate, and contracts, values and tools for the modules with build
functions. Beside it there are `crowdbot` (the [Python API](../reference/python_api.md)),
`crowdbot.errors` and `crowdbot.testing`. Everything else may change from one version to the next.
crowdbot's own components import from here, too.

Names are imported when they are first used: a module that needs only `Command` does not wait for
numba, and one that needs only names of the first two sections imports no numpy. The page
[plugins](../reference/plugins.md) says what a component is, and what its methods are called with.
"""
_HEAD_OF_ROOMS = """\
## Tools for some components

What crowdbot's own metrics, sensors, crowds and environments use beside that. They are modules of
their own, for the build side.
"""
#: Name without a docstring -> its description.
_SAID = {
    "Better": "Which scores are better: `higher`, `lower`, those near the `reference`, or `none`.",
    "Incidence": "Angle between a ray and a surface's normal, above 0, at most a right angle.",
    "PlannerDocument": "The planner within a planner: its document, its kind, or a file.",
    "DescribedPart": "What a robot's description names: `link` or `joint`.",
    "PlannerRole": "What a planner is there for: `floor`, `baseline`, `ceiling` or `candidate`.",
    "MOST_RAYS": "Rays that one reading of a sensor may take.",
    "LOOP": "`Agents.at_goal`: walk back to the first point of the route.",
    "PORTAL": "`Agents.at_goal`: leave through a portal and come in by its entrance.",
    "REMOVE": "`Agents.at_goal`: leave the world.",
    "STOP": "`Agents.at_goal`: stand there.",
    "Answer": "An answer to a question, or None.",
    "DISTANCE_TOLERANCE": "Tolerance of the distance within which people count as near, m.",
    "MOST": "Largest evasion that people reach, m/s².",
    "NO_RAYS": "An array of no rays.",
    "DEEPEST": "Deepest nesting of a document of others.",
    "LARGEST_TABLE": "Largest table or picture that is read, bytes.",
    "MOST_MILLIMETRES": "Farthest depth that whole millimetres in 16 bits can say, m.",
    "TLX_SCALES": "Scales of the questionnaire NASA-TLX.",
    "USE_ITEMS": "Scale -> number of items of the questionnaire USE.",
    "hookimpl": "Marks a function as a hook: `@hookimpl`.",
    "Heights": "Bottom and top, m.",
    "CONTACT_STIFFNESS": "Push between overlapping people where a policy does not say, 1/s².",
    "CrowdPolicy": "A `VelocityPolicy` or an `AcceleratingPolicy`.",
    "PolicyFactory": "Makes the policy of some agents.",
    "Pointer": "Pointer to float64, which a compiled cost function gets in place of an array.",
    "as_record": "The record at a pointer, or at the beginning of an array, in place.",
    "as_rows": "The records at a pointer, or in a contiguous array, in place.",
    "Array": "float64 array.",
    "Indices": "int64 array.",
    "Mask": "bool array.",
}
#: Names that say what they mean together.
_TOGETHER: Mapping[str, str] = {
    "BASE EXCESS GRADIENT LOWER_BOUND OPTIMUM PREPARE": (
        "Signatures of the functions of a `CompiledCost`."
    ),
    "WORK_COLUMNS": "Numbers in a row of `work`.",
    "COST_PARAMS": "The record of `CostParams`, for functions without parameters of their own.",
    "X Y RADIUS BOTTOM TOP": (
        "Columns of bodies of people: centre, radius, lower and upper end, m."
    ),
    "NEAR FAR LOW HIGH": (
        "Columns of a fan of rays: where a body begins and ends along it, and its heights, m."
    ),
    "ZERO ALONG_PREFERRED PREFERRED_SPEED": (
        "For `Sampling`: no velocity as base, the preferred direction as axis, the preferred speed "
        "as radius."
    ),
    "MORE_WALLS": "Result of `prepare` where walls that were not given may matter.",
    "SAME_POINT": "Nearest points of walls that are nearer to each other than this in x and in y "
    "count once, m.",
    "NEAR_WALLS": "`wall_reach` of functions whose farther walls `first_collision` looks up, m.",
}
#: Heading -> beginnings of the modules, below crowdbot.core, from which its names come.
_GROUPS: Mapping[str, tuple[str, ...]] = {
    "Build functions": ("crowdbot.plugin.build_functions",),
    "Planners": ("planning", "types.motion", "types.task", "types.person", "sensing.points",
                 "batch.imagined"),
    "Sensors and noise": ("sensing", "types.sensor"),
    "Robots": ("robots", "types.robot", "geometry"),
    "Environments": ("types.environment", "environments"),
    "Metrics": ("scoring", "types.score", "trajectories"),
    "Recordings": ("recording",),
    "Crowd": ("crowd.agents", "crowd.desired", "crowd.engine", "crowd.from", "crowd.policy",
              "crowd.recorded", "crowd.world"),
    "Cost functions": ("crowd.velocity_search", "crowd.contact"),
    "Arrays and compiled code": ("types.arrays", "support", "geometry.rotation", "geometry.rough"),
}  # fmt: skip


def author_surface_page() -> str:
    """The whole page as Markdown."""
    parts = [_HEAD, "## Specs and components\n", _table(_specs())]
    parts.append("## Quantities\n\nNumbers in the unit given; documents may use others.\n")
    parts.append(_table(_quantities()))
    for title in _GROUPS:
        parts += [f"## {title}\n", _table(_group(title))]
    parts.append(_HEAD_OF_ROOMS)
    for room in ROOMS:
        parts += [f"### {room.__name__}\n", _table(_rows(room, room.__all__))]
    return "\n".join(parts).rstrip() + "\n"


def _table(rows: Iterator[tuple[str, str]]) -> str:
    return "\n".join(["| name | |", "|---|---|", *(f"| {n} | {t} |" for n, t in rows), ""])


def _of_documents() -> list[str]:
    """Return the names that modules of specs import: none of core."""
    return [
        n for n in plugin.__all__ if not _home(n).startswith(("crowdbot.core.", "crowdbot.plugin."))
    ]


def _specs() -> Iterator[tuple[str, str]]:
    for name in _of_documents():
        if name in _SAID or not _is_quantity(getattr(plugin, name)):
            yield f"`{name}`", _line(name)


def _quantities() -> Iterator[tuple[str, str]]:
    for name in _of_documents():
        value = getattr(plugin, name)
        if name not in _SAID and _is_quantity(value):
            (quantity,) = (m for m in get_args(value) if isinstance(m, Quantity))
            yield f"`{name}`", f"{quantity.dimension}, {next(iter(UNITS[quantity.dimension]))}"


def _is_quantity(value: object) -> bool:
    return get_origin(value) is Annotated


def _group(title: str) -> Iterator[tuple[str, str]]:
    of_documents = _of_documents()
    names = [n for n in plugin.__all__ if n not in of_documents and _title(n) == title]
    yield from _rows(plugin, names)


def _rows(module: ModuleType, names: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield a line on each name of a module, those that say what they mean together first."""
    together = {n: words for words in _TOGETHER for n in words.split()}
    for words in dict.fromkeys(together[n] for n in names if n in together):
        yield ", ".join(f"`{n}`" for n in words.split()), _TOGETHER[words]
    for name in names:
        if name not in together:
            yield f"`{name}`", _line(name, module)


def _title(name: str) -> str:
    home = _home(name).removeprefix("crowdbot.core.")
    fitting = [(len(m), t) for t, modules in _GROUPS.items() for m in modules if home.startswith(m)]
    return max(fitting)[1]


def _home(name: str) -> str:
    return stub_names(plugin.__file__)[name].module


def _line(name: str, module: ModuleType = plugin) -> str:
    """The first paragraph of a docstring, in one line."""
    if name in _SAID:
        return _SAID[name]
    value: Any = getattr(module, name)
    if isinstance(value, int | float | str | tuple):  # its type's docstring says nothing
        raise SystemExit(f"{PAGE.name}: describe {name} in {Path(__file__).name}")
    text = inspect.getdoc(getattr(value, "py_func", value)) or ""
    return " ".join(text.partition("\n\n")[0].replace("``", "`").replace("|", "\\|").split())
