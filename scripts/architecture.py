"""Count the rooms of crowdbot, the arrows between them, imports that go up, and import circles.

Imports under TYPE_CHECKING and inside functions count like all others, and so do those that are
written as text (`import_module`, stubs of lazy names), except in the lazy faces for users and
authors.
The floors are those of the layers contracts in pyproject.toml. Ends with 1 when something is out
of place.

Examples:
    .venv/bin/python scripts/architecture.py
    .venv/bin/python scripts/architecture.py --json
"""

from __future__ import annotations

import argparse
import ast
import json
import sys
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import grimp
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from scripts.imports_as_text import LAZY_FACES, faces_imported_within, imports_as_text

ROOT = Path(__file__).parent.parent
CORE = ROOT / "crowdbot" / "core"
PAGE = ROOT / "docs" / "decisions" / "0002-floors.md"
BEGIN = "<!-- Written by make generate: -->\n"
END = "<!-- end -->\n"
#: Most files in one folder, without those below; and the folders that may have more.
MOST_FILES = 30
MAY_BE_FULL = ("crowdbot/plugins/metrics", "crowdbot/core/sim")

#: Typing-only imports that may go up: the words of messages and hooks, which nothing executes.
MAY_GO_UP = {
    ("crowdbot.errors", "crowdbot.dsl"),
    ("crowdbot.hookspecs", "crowdbot.dsl"),
}
#: Old names of what plugins import, which forward to the new ones until 1.0.
OLD_NAMES = {
    ("crowdbot.core.interfaces", "crowdbot.plugin"),
    ("crowdbot.dsl", "crowdbot.plugin"),
}

Import = tuple[str, str]


@dataclass(frozen=True)
class Room:
    """A folder of crowdbot/core, or a loose file: what it holds and which rooms it imports."""

    name: str
    floor: int
    holds: str
    imports: list[str]
    files: int


@dataclass(frozen=True)
class Architecture:
    """What was counted. ``upward`` and ``circles`` hold module names."""

    rooms: list[Room]
    loose_files: list[str]
    upward: list[Import]
    circles: list[list[str]]
    room_circles: list[list[str]]
    allowed_upward: list[Import]
    own_faces: list[Import]
    full_folders: dict[str, int]

    @property
    def arrows(self) -> int:
        """Pairs of rooms of which the first imports the second."""
        return sum(len(room.imports) for room in self.rooms)

    @property
    def in_order(self) -> bool:
        """True if no file is loose, no import goes up or in a circle, and no folder is too full."""
        wrong = (self.loose_files, self.upward, self.circles, self.room_circles)
        return not any((*wrong, self.own_faces, self.full_folders))

    def counts(self) -> dict[str, int]:
        """Measure -> number."""
        return {
            "rooms of core": len(self.rooms),
            "loose files": len(self.loose_files),
            "arrows between rooms": self.arrows,
            "imports that go up": len(self.upward),
            "import circles of files": len(self.circles),
            "import circles of rooms": len(self.room_circles),
            "imports of the own package's face": len(self.own_faces),
            f"folders of more than {MOST_FILES} files": len(self.full_folders),
        }


def measure() -> Architecture:
    """Read the sources of crowdbot and count."""
    graph = grimp.build_graph("crowdbot", cache_dir=None)
    executed = grimp.build_graph("crowdbot", exclude_type_checking_imports=True, cache_dir=None)
    imports = [(a, b) for a in graph.modules for b in graph.find_modules_directly_imported_by(a)]
    imports += imports_as_text(ROOT, sorted(graph.modules))
    upward = sorted(pair for pair in imports if goes_up(*pair))
    typing_only = {p for p in upward if _has(graph, p) and not _has(executed, p)}
    allowed = [p for p in upward if p in OLD_NAMES or (p in typing_only and _may_go_up(p))]
    arrows = {(a, b) for a, b in ((_room(a), _room(b)) for a, b in imports) if a and b and a != b}
    loose = sorted(file.stem for file in CORE.glob("*.py") if file.stem != "__init__")
    return Architecture(
        rooms=_rooms(arrows, loose),
        loose_files=loose,
        upward=[pair for pair in upward if pair not in allowed],
        circles=circles(imports),
        room_circles=circles(sorted(arrows)),
        allowed_upward=allowed,
        own_faces=[
            pair
            for pair in faces_imported_within(ROOT, sorted(graph.modules))
            if pair[1] not in LAZY_FACES
        ],
        full_folders=_full_folders(),
    )


def circles(imports: Sequence[Import]) -> list[list[str]]:
    """Groups of names that all import one another, directly or through others of the group."""
    names = sorted({name for pair in imports for name in pair})
    index = {name: i for i, name in enumerate(names)}
    ends = np.array([[index[a], index[b]] for a, b in imports]).reshape(-1, 2).T
    matrix = coo_array((np.ones(ends.shape[1]), (ends[0], ends[1])), shape=(len(names),) * 2)
    _, group = connected_components(matrix, connection="strong")
    members = [[names[i] for i in np.flatnonzero(group == g)] for g in np.unique(group)]
    return [found for found in members if len(found) > 1]


def _full_folders() -> dict[str, int]:
    """Folder -> number of its files, where it has too many."""
    folders = [d for d in (ROOT / "crowdbot").rglob("*/") if d.is_dir()]
    counts = {d.relative_to(ROOT).as_posix(): len(list(d.glob("*.py"))) for d in sorted(folders)}
    return {d: n for d, n in counts.items() if n > MOST_FILES and d not in MAY_BE_FULL}


def _floors(container: str | None) -> dict[str, int]:
    """Full module name -> its floor, the lowest 1, of one layers contract in pyproject.toml."""
    config = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]
    for contract in config["contracts"]:
        if contract["type"] == "layers" and contract.get("containers", [None])[0] == container:
            return {
                f"{container}.{name}" if container else name: floor
                for floor, layer in enumerate(reversed(contract["layers"]), 1)
                for name in layer.replace(":", "|").replace(" ", "").split("|")
            }
    raise SystemExit(f"pyproject.toml has no layers contract of {container or 'the package'}")


_PACKAGE_FLOORS, _CORE_FLOORS = _floors(None), _floors("crowdbot.core")


def goes_up(importer: str, imported: str) -> bool:
    """True if an import leaves its floor in any direction but down."""
    both = (_PACKAGE_FLOORS, _CORE_FLOORS)
    return any(_not_down(_layer(importer, f), _layer(imported, f), f) for f in both)


def _not_down(importer: str | None, imported: str | None, floors: Mapping[str, int]) -> bool:
    if importer is None or imported is None or importer == imported:
        return False
    return floors[importer] <= floors[imported]


def _layer(module: str, floors: Mapping[str, int]) -> str | None:
    """The layer that a module lies in."""
    return next((n for n in floors if module == n or module.startswith(f"{n}.")), None)


def _may_go_up(pair: Import) -> bool:
    return any(pair[0] == low and pair[1].startswith(f"{high}.") for low, high in MAY_GO_UP)


def _has(graph: grimp.ImportGraph, pair: Import) -> bool:
    return graph.direct_import_exists(importer=pair[0], imported=pair[1])


def _room(module: str) -> str | None:
    """The part of a module's name that says its room of core; None outside core."""
    parts = module.split(".")
    return parts[2] if parts[:2] == ["crowdbot", "core"] and len(parts) > 2 else None


def _rooms(arrows: set[Import], loose: Sequence[str]) -> list[Room]:
    """The folders and loose files of core, the highest floor first."""
    folders = sorted(file.parent.name for file in CORE.glob("*/__init__.py"))
    rooms = [
        Room(
            name,
            floor=_CORE_FLOORS.get(f"crowdbot.core.{name}", 0),
            holds=_summary(name),
            imports=sorted(b for a, b in arrows if a == name),
            files=len(list((CORE / name).rglob("*.py"))) if name in folders else 1,
        )
        for name in (*folders, *loose)
    ]
    return sorted(rooms, key=lambda room: (-room.floor, room.name))


def _summary(name: str) -> str:
    """First line of a room's docstring."""
    file = CORE / name / "__init__.py"
    tree = ast.parse((file if file.exists() else CORE / f"{name}.py").read_text("utf-8"))
    return (ast.get_docstring(tree) or "").split("\n")[0]


def markdown(found: Architecture) -> str:
    """The table of docs/decisions/0002-floors.md."""
    counts = ", ".join(f"{number} {what}" for what, number in found.counts().items())
    lines = [f"{counts}.", "", "| floor | room | holds | imports |", "|---|---|---|---|"]
    for room in found.rooms:
        imports = ", ".join(f"`{name}`" for name in room.imports)
        lines.append(f"| {room.floor} | `{room.name}` | {room.holds} | {imports} |")
    return "\n".join(lines) + "\n"


def plain(found: Architecture) -> str:
    """The counts, the rooms, and whatever is out of place, for a terminal."""
    lines = [f"{number:5}  {what}" for what, number in found.counts().items()]
    lines += ["", "floor  room           files  imports"]
    for room in found.rooms:
        imports = " ".join(room.imports)
        lines.append(f"{room.floor:5}  {room.name:<13}  {room.files:5}  {imports}")
    lines += [f"goes up: {a} -> {b}" for a, b in found.upward]
    lines += [f"goes up, allowed: {a} -> {b}" for a, b in found.allowed_upward]
    lines += [f"circle: {' <-> '.join(names)}" for names in (*found.circles, *found.room_circles)]
    lines += [f"imports its own package's face: {a} -> {b}" for a, b in found.own_faces]
    lines += [f"{n} files: {folder}" for folder, n in found.full_folders.items()]
    return "\n".join(lines) + "\n"


def page_with_table(text: str, found: Architecture) -> str:
    """The decision's text with the table renewed between its two marks."""
    head, rest = text.split(BEGIN)
    return f"{head}{BEGIN}\n{markdown(found)}\n{END}{rest.split(END)[1]}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Prints what was asked for; 1 if something is out of place."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="everything, for programs")
    form.add_argument("--markdown", action="store_true", help="the table of decision 0002")
    asked, found = parser.parse_args(arguments), measure()
    if asked.json:
        print(json.dumps({"counts": found.counts(), **asdict(found)}, indent=2))
    else:
        print(markdown(found) if asked.markdown else plain(found), end="")
    return 0 if found.in_order else 1


if __name__ == "__main__":
    sys.exit(main())
