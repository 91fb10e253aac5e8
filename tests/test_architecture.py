"""What the import contracts cannot say."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import crowdbot
from scripts import architecture, imports_as_text
from tests.paths import TESTS

PACKAGE = Path(crowdbot.__file__).parent
MIRRORED = ["core", "plugins", "dsl", "cli", "testing"]


@pytest.fixture(scope="module")
def found() -> architecture.Architecture:
    """What the script counts, once for all tests."""
    return architecture.measure()


def test_no_file_of_core_is_loose(found: architecture.Architecture) -> None:
    assert found.loose_files == []


def test_no_import_goes_up_not_even_for_types(found: architecture.Architecture) -> None:
    assert found.upward == []


def test_no_files_import_in_a_circle_not_even_for_types(found: architecture.Architecture) -> None:
    assert found.circles == []
    assert found.room_circles == []


def test_no_module_imports_the_face_of_its_own_package(found: architecture.Architecture) -> None:
    assert found.own_faces == []


def test_no_folder_has_more_files_than_one_can_look_through(
    found: architecture.Architecture,
) -> None:
    assert found.full_folders == {}


TEXTS = {
    "crowdbot.core.low": 'from importlib import import_module\nimport_module("crowdbot.core.high")',
    "crowdbot.core.high": 'importlib.import_module(f"crowdbot.core.rooms.{name}")',
    "crowdbot.core.lazy": "__getattr__ = lazy_names(__name__, stub_names(__file__))",
    "crowdbot.core.named": 'import_module(name)\nimport_module("numpy.linalg")',
    "crowdbot.core.rooms": "from crowdbot.core.rooms.own import b",
    "crowdbot.core.rooms.own": "from crowdbot.core.rooms import b\nb = 1",
    "crowdbot.core.rooms.other": "import crowdbot.core.rooms.own as own",
}


@pytest.fixture
def made_up(tmp_path: Path) -> Path:
    """A package that imports in all the ways that a graph does not show."""
    for name, text in TEXTS.items():
        place = tmp_path / name.replace(".", "/")
        inside = any(other.startswith(f"{name}.") for other in TEXTS)
        file = place / "__init__.py" if inside else place.with_suffix(".py")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    stub = tmp_path / "crowdbot" / "core" / "lazy.pyi"
    stub.write_text(
        "from crowdbot.core.high import a as a\nfrom crowdbot.core.high import b as c\n"
    )
    return tmp_path


def test_imports_that_are_written_as_text_count(made_up: Path) -> None:
    assert imports_as_text.imports_as_text(made_up, [*TEXTS]) == [
        ("crowdbot.core.high", "crowdbot.core.rooms"),
        ("crowdbot.core.lazy", "crowdbot.core.high"),
        ("crowdbot.core.low", "crowdbot.core.high"),
    ]


def test_a_module_that_imports_its_own_face_is_found(made_up: Path) -> None:
    assert imports_as_text.faces_imported_within(made_up, [*TEXTS]) == [
        ("crowdbot.core.rooms.own", "crowdbot.core.rooms")
    ]


def test_circles_are_found_through_others_and_chains_are_none() -> None:
    chain = [("a", "b"), ("b", "c"), ("d", "c")]
    assert architecture.circles(chain) == []
    assert architecture.circles([*chain, ("c", "a")]) == [["a", "b", "c"]]
    assert architecture.circles([]) == []


@pytest.mark.parametrize(
    ("importer", "imported", "up"),
    [
        ("crowdbot.dsl.suite.suite", "crowdbot.core.support.ticks", True),
        ("crowdbot.core.support.ticks", "crowdbot.dsl.suite.suite", False),
        ("crowdbot.core.crowd.engine", "crowdbot.core.sim.plant", True),
        ("crowdbot.core.crowd.engine", "crowdbot.core.sensing.noise", True),  # beside it
        ("crowdbot.core.sim.plant", "crowdbot.core.crowd.engine", False),
        ("crowdbot.core.crowd.engine", "crowdbot.core.crowd.contact.geometry", False),
    ],
)
def test_what_goes_up(importer: str, imported: str, up: bool) -> None:
    assert architecture.goes_up(importer, imported) is up


def test_only_the_simulation_imports_drake() -> None:
    users = [f.relative_to(PACKAGE) for f in _sources() if _imports_any(f, {"pydrake"})]
    assert users
    # The conformance kit drives robots of others, too.
    allowed = (("core", "sim"), ("testing",))
    assert [f for f in users if not any(f.parts[: len(a)] == a for a in allowed)] == []


def test_what_validating_imports_needs_no_numbers_library() -> None:
    """Of a plugin's two files only the ``_build`` one may import what is slow to import."""
    heavy = {"numpy", "numba", "pydrake"}
    for file in (PACKAGE / "plugins").rglob("*.py"):
        if not file.stem.endswith("_build"):
            assert not _imports_any(file, heavy), file


def test_core_never_names_plugins() -> None:
    for file in (PACKAGE / "core").rglob("*.py"):
        assert "crowdbot.plugins" not in file.read_text("utf-8"), file


def test_no_two_public_classes_have_the_same_name() -> None:
    """Whoever reads a name in a message, a page or a traceback has one place to look."""
    places: dict[str, list[Path]] = {}
    for file in _sources():
        # Also in what merely looks like a class, such as the text of a template.
        for name in set(re.findall(r"^class ([A-Za-z]\w*)", file.read_text("utf-8"), re.MULTILINE)):
            places.setdefault(name, []).append(file)
    several = {name: files for name, files in places.items() if len(files) > 1}
    found = {name: [f for f in files if name in _classes(f)] for name, files in several.items()}
    assert {name: files for name, files in found.items() if len(files) > 1} == {}


@pytest.mark.parametrize("part", MIRRORED)
def test_tests_mirror_the_code(part: str) -> None:
    folders = [f.relative_to(TESTS) for f in (TESTS / part).rglob("*/") if f.name != "__pycache__"]
    assert [f for f in folders if not (PACKAGE / f / "__init__.py").is_file()] == []


@pytest.mark.slow
def test_tests_are_packages_and_import_one_another_by_their_whole_path() -> None:
    """Otherwise two helpers of one name are one module, and where pytest starts matters."""
    for file in TESTS.rglob("*.py"):
        if "data" not in file.relative_to(TESTS).parts:
            beside = {other.stem for other in file.parent.glob("*.py")} - {"__init__"}
            assert (file.parent / "__init__.py").is_file(), file
            assert not _imports_any(file, beside), file


def _sources() -> Iterator[Path]:
    """All modules of crowdbot."""
    return PACKAGE.rglob("*.py")


def _classes(file: Path) -> set[str]:
    """The classes that a module defines at its top level."""
    body = ast.parse(file.read_text("utf-8")).body
    return {node.name for node in body if isinstance(node, ast.ClassDef)}


def _imports_any(file: Path, packages: set[str]) -> bool:
    """True if a file imports one of some packages, wherever in it.

    Files in which none of the names follows one of the two words are not parsed, since parsing all
    of them takes two seconds.
    """
    lines = re.findall(r"\b(?:import|from)\b(.*)", file.read_text("utf-8"))
    named = packages & set(re.findall(r"\w+", " ".join(lines)))
    return bool(named) and not named.isdisjoint(_imported(file))


def _imported(file: Path) -> Iterator[str]:
    """The top-level names of all packages that a file imports, wherever in it."""
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield "." if node.level else (node.module or "").split(".")[0]
