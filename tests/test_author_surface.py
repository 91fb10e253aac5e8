"""What plugins import: two modules, a snapshot of their names, and nobody who goes past them."""

from __future__ import annotations

import ast
import importlib
import re
import runpy
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from crowdbot import dsl
from crowdbot.core import interfaces
from tests.docs.doc_pages import PAGES, blocks
from tests.paths import DATA, ROOT

SURFACE = ("crowdbot.dsl", "crowdbot.core.interfaces")
PUBLIC = (*SURFACE, "crowdbot", "crowdbot.errors", "crowdbot.hookspecs", "crowdbot.testing")
#: What a package's own tests may import beside that: the command line as a function.
COMMAND = "crowdbot.cli"
#: Components that others build on are theirs to import, as those of any package are.
COMPONENTS = "crowdbot.plugins."
#: Looks inside a run, for whoever works on crowdbot itself: nobody's package.
INSIDE = "docs/howto/files/draw_diagram.py"
_IMPORT = re.compile(r"^\s*(?:from|import) (crowdbot(?:\.\w+)*)(?![\w$])", re.MULTILINE)


def test_the_names_are_those_of_the_snapshot() -> None:
    found = [f"{m.__name__}.{n}" for m in (dsl, interfaces) for n in sorted(m.__all__)]
    kept = (DATA / "author_surface.txt").read_text().splitlines()
    assert found == kept, "a change of what plugins import: say so in CHANGELOG.md"
    assert len(set(found)) == len(found)
    assert not set(dsl.__all__) & set(interfaces.__all__), "one name, one module"


@pytest.mark.parametrize("name", interfaces.__all__)
def test_every_name_of_the_build_side_resolves(name: str) -> None:
    assert getattr(interfaces, name) is not None
    assert name in dir(interfaces)
    with pytest.raises(AttributeError, match="has no attribute"):
        getattr(interfaces, name + "_")


def test_the_page_is_up_to_date() -> None:
    script = runpy.run_path(str(ROOT / "scripts" / "write_author_surface.py"))
    page = (ROOT / "docs" / "reference" / "author_surface.md").read_text(encoding="utf-8")
    assert page == script["author_surface_page"](), "run scripts/write_author_surface.py"


def test_the_page_has_a_line_on_each_name() -> None:
    page = (ROOT / "docs" / "reference" / "author_surface.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (`.*?) \| (.*) \|$", page, re.MULTILINE)
    told = {name: text for names, text in rows for name in re.findall(r"`(\w+)`", names)}
    assert told.keys() == {*dsl.__all__, *interfaces.__all__}
    assert [n for n, text in told.items() if not text.strip()] == []


def _sources() -> Iterator[tuple[str, str]]:
    """Name and text of all that others copy from: pages, templates, examples, and our plugins."""
    for page in PAGES:
        for i, block in enumerate(b for b in blocks(page) if b.language == "python"):
            if block.names == ROOT / INSIDE:
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
    assert {m for _, m in SOURCES} >= set(SURFACE)


def _imports(file: Path) -> Iterator[tuple[str, str]]:
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            yield from ((node.module, alias.name) for alias in node.names)


@pytest.mark.parametrize(
    "file",
    sorted((ROOT / "crowdbot" / "plugins").rglob("*.py")),
    ids=lambda f: f.relative_to(ROOT).as_posix(),
)
def test_our_own_plugins_import_from_where_others_do(file: Path) -> None:
    """What is on the surface comes from there; a few tools of ours are not on it."""
    for module, name in _imports(file):
        assert not module.startswith("crowdbot.dsl."), module
        if module.startswith("crowdbot.core.") and module != interfaces.__name__:
            found = getattr(importlib.import_module(module), name)
            same = callable(found) and found is getattr(interfaces, name, None)
            assert not same, f"{name} comes from {module}"
            assert name not in interfaces._HOMES.get(module, "").split(), f"{module}: {name}"


def test_the_build_side_is_cheap_until_it_is_used() -> None:
    code = (
        "import sys\n"
        "import crowdbot.core.interfaces\n"
        "from crowdbot.core.interfaces import Command\n"
        "print(*sorted({'numba', 'pydrake', 'mcap'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
