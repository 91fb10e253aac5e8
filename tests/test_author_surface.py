"""The module that plugins import: a snapshot of its names, and all who go through it."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from crowdbot import plugin
from crowdbot.lazy import stub_names
from crowdbot.plugin import for_crowds, for_environments, for_learning, for_metrics, for_sensors
from tests.docs.doc_pages import PAGES, blocks
from tests.paths import DATA, ROOT

ROOMS = (for_metrics, for_sensors, for_crowds, for_environments, for_learning)
SURFACE = ("crowdbot.plugin", *(room.__name__ for room in ROOMS))
PUBLIC = (*SURFACE, "crowdbot", "crowdbot.errors", "crowdbot.rl", "crowdbot.testing")
#: What a package's own tests may import beside that: the command line as a function.
COMMAND = "crowdbot.cli"
#: Components that others build on are theirs to import, as those of any package are.
COMPONENTS = "crowdbot.plugins."
#: Looks inside a run, for people who work on crowdbot itself: not for packages.
INSIDE = "docs/howto/files/draw_diagram.py"
_IMPORT = re.compile(r"^\s*(?:from|import) (crowdbot(?:\.\w+)*)(?![\w$])", re.MULTILINE)


def test_the_names_are_those_of_the_snapshot() -> None:
    kept = (DATA / "author_surface.txt").read_text().splitlines()
    found = [f"{m.__name__}.{n}" for m in (plugin, *ROOMS) for n in sorted(m.__all__)]
    assert found == kept, "a change of what plugins import: say so in CHANGELOG.md"


@pytest.mark.parametrize("name", plugin.__all__)
def test_every_name_resolves(name: str) -> None:
    assert getattr(plugin, name) is not None
    assert name in dir(plugin)
    with pytest.raises(AttributeError, match="has no attribute"):
        getattr(plugin, name + "_")


def test_the_page_has_a_line_on_each_name() -> None:
    page = (ROOT / "docs" / "developers" / "author_surface.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (`.*?) \| (.*) \|$", page, re.MULTILINE)
    values = {name: text for names, text in rows for name in re.findall(r"`(\w+)`", names)}
    assert values.keys() == {n for module in (plugin, *ROOMS) for n in module.__all__}
    assert [n for n, text in values.items() if not text.strip()] == []


def _sources() -> Iterator[tuple[str, str]]:
    """Name and text of all that others copy from: pages, templates, examples, and our plugins."""
    for page in PAGES:
        for i, block in enumerate(b for b in blocks(page) if b.language == "python"):
            if block.names is not None and block.names.resolve() == ROOT / INSIDE:
                continue
            yield f"{page.relative_to(ROOT)}[{i}]", block.text
    for folder, pattern in (("crowdbot/templates", "*.tmpl"), ("docs", "*.py")):
        for file in sorted((ROOT / folder).rglob(pattern)):
            name = file.relative_to(ROOT).as_posix()
            if name != INSIDE and not {".venv", "build", "dist"} & set(file.parts):
                yield name, file.read_text(encoding="utf-8")


SOURCES = [
    (name, module) for name, text in _sources() for module in sorted(set(_IMPORT.findall(text)))
]


@pytest.mark.parametrize(("source", "module"), SOURCES)
def test_what_others_copy_imports_the_surface_only(source: str, module: str) -> None:
    fine = module in PUBLIC or module.startswith(COMPONENTS)
    assert fine or (module == COMMAND and "test_" in source), f"{source} imports {module}"


def test_many_sources_were_looked_at() -> None:
    assert len({s for s, _ in SOURCES}) > 50
    assert {m for _, m in SOURCES} >= {"crowdbot", "crowdbot.plugin"}


def _imports(file: Path) -> Iterator[tuple[str, str]]:
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            yield from ((node.module, alias.name) for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from ((alias.name, "") for alias in node.names)


@pytest.mark.parametrize(
    "file",
    sorted((ROOT / "crowdbot" / "plugins").rglob("*.py")),
    ids=lambda f: f.relative_to(ROOT).as_posix(),
)
def test_our_own_plugins_import_from_where_others_do(file: Path) -> None:
    others = {m for m, _ in _imports(file) if m.startswith("crowdbot")}
    past = {m for m in others - set(SURFACE) if not m.startswith(COMPONENTS)}
    assert past == set()


def test_modules_of_specs_import_names_of_documents_only() -> None:
    """Import-linter does not see what a name of `crowdbot.plugin` imports when it is used."""
    homes = stub_names(plugin.__file__).items()
    heavy = {name for name, home in homes if home.module.startswith("crowdbot.core.")}
    assert heavy
    for file in (ROOT / "crowdbot" / "plugins").rglob("*.py"):
        if not file.stem.endswith("_build"):
            found = list(_imports(file))
            assert not {m for m, _ in found} & set(SURFACE[1:]), file
            names = {name for module, name in found if module == "crowdbot.plugin"}
            assert not names & heavy, (file, names & heavy)


def test_the_build_side_is_cheap_until_it_is_used() -> None:
    code = (
        "import sys\n"
        "import crowdbot.plugin\n"
        "from crowdbot.plugin import Command\n"
        "print(*sorted({'numba', 'pydrake', 'mcap'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
