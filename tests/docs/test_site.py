"""The site of the documentation: every page is reached, every public name has its entry."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

import crowdbot
from scripts import make_pictures
from tests.docs.doc_pages import read
from tests.paths import ROOT

DOCS = ROOT / "docs"


def _navigated() -> set[Path]:
    """Pages that the navigation reaches from the index."""
    found: set[Path] = set()
    todo = [DOCS / "index.md"]
    while todo:
        page = todo.pop()
        trees = re.findall(
            r"^```\{toctree\}\n(.*?)^```$", page.read_text("utf-8"), re.MULTILINE | re.DOTALL
        )
        globs = [w for t in trees for w in t.splitlines() if w and not w.startswith(":")]
        named = {p.resolve() for g in globs for p in page.parent.glob(f"{g}.md")}
        todo += named - found
        found |= named
    return found


def test_each_page_has_one_place_in_the_navigation() -> None:
    trees = re.findall(r"^```\{toctree\}\n(.*?)^```$", read("index.md"), re.MULTILINE | re.DOTALL)
    named = [w for t in trees for w in t.splitlines() if w and not w.startswith(":")]
    assert len(named) == len(set(named))
    assert not [w for w in named if "*" in w], "the order is made by hand"


def test_the_navigation_reaches_every_page() -> None:
    pages = set(DOCS.rglob("*.md")) - {DOCS / "index.md"}
    assert {p.relative_to(DOCS).as_posix() for p in pages - _navigated()} == set()


def test_decisions_are_in_order() -> None:
    numbers = [p.name[:4] for p in sorted((DOCS / "decisions").glob("*.md"))]
    assert all(re.fullmatch(r"\d{4}", n) for n in numbers)
    assert len(set(numbers)) == len(numbers)


@pytest.mark.parametrize("name", crowdbot.__all__)
def test_every_public_name_has_a_documented_entry(name: str) -> None:
    page = read("reference/python_api.md")
    assert re.search(rf"^\.\. auto\w+:: crowdbot\.{name}$", page, re.MULTILINE)
    assert re.search(rf"^\|.*`{name}`.*\|", page, re.MULTILINE), "not in the table"
    assert (inspect.getdoc(getattr(crowdbot, name)) or "").strip()


def _members() -> list[tuple[str, str]]:
    found = re.findall(
        r"^\.\. autoclass:: crowdbot\.(\w+)\n   :members: (.*)$",
        read("reference/python_api.md"),
        re.MULTILINE,
    )
    return [(name, member) for name, members in found for member in members.split(", ")]


@pytest.mark.parametrize(("name", "member"), _members())
def test_every_member_of_the_page_is_there_and_documented(name: str, member: str) -> None:
    assert inspect.getdoc(getattr(getattr(crowdbot, name), member))


@pytest.mark.parametrize("name", ["Session", "Run", "Scores", "Results", "Trajectories"])
def test_the_page_leaves_no_public_member_out(name: str) -> None:
    shown = {member for owner, member in _members() if owner == name}
    fields = set(getattr(getattr(crowdbot, name), "__dataclass_fields__", ()))
    inherited = {"index", "count", "cached"}  # of every sequence; for metrics
    public = {m for m in dir(getattr(crowdbot, name)) if not m.startswith("_")}
    assert public - fields - inherited <= shown


def test_figures_of_a_run_are_written_into_the_readme() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    lines = [f"{m} 0.123{i} higher is better" for i, m in enumerate(make_pictures.SHOWN)]
    ending = f"{make_pictures.ID} · dwa · seed 0: arrived after 12.3 s (4.5 times\nreal time)"
    made = make_pictures.with_figures(readme, "\n".join([*lines, ending]))
    assert all(line in made for line in [*lines, ending])
    assert len(made.splitlines()) == len(readme.splitlines())
    with pytest.raises(SystemExit, match="safe efficiency is not shown"):
        make_pictures.with_figures(readme, ending)


def test_pictures_of_the_gallery_are_those_that_are_drawn() -> None:
    shown = set(re.findall(r"images/gallery/(\w+)\.svg", read("gallery.md")))
    assert shown == set(make_pictures.GALLERY)
    assert {p.stem for p in (DOCS / "images" / "gallery").glob("*.svg")} == shown


@pytest.mark.slow
def test_the_notebook_runs(tmp_path: Path) -> None:
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    notebook = nbformat.read(DOCS / "tutorial" / "files" / "crowdbot.ipynb", as_version=4)
    nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3",
                            resources={"metadata": {"path": str(tmp_path)}}).execute()  # fmt: skip
    shown = [
        output["data"]
        for cell in notebook.cells
        for output in cell.get("outputs", ())
        if "data" in output
    ]
    html = "".join("".join(data.get("text/html", "")) for data in shown)
    assert "<svg" in html
    assert "<iframe srcdoc=" in html
    assert "<table" in html
    assert "'careful'" in "".join("".join(data["text/plain"]) for data in shown)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_session_in_the_reference_runs(tmp_path: Path) -> None:
    script = DOCS / "reference" / "files" / "python_session.py"
    done = subprocess.run(
        [sys.executable, script], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == ["timeout", "2.0"]
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_pages_are_understood(tmp_path: Path) -> None:
    """A site of a few pages, warnings being errors; `make docs` makes all of it."""
    pytest.importorskip("sphinx")
    for page in ("reference/python_api.md", "tutorial/notebook.md"):
        (tmp_path / page).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / page).write_text(read(page), encoding="utf-8")
    (tmp_path / "tutorial" / "files").mkdir()
    (tmp_path / "tutorial" / "files" / "crowdbot.ipynb").write_text("{}")
    (tmp_path / "conf.py").write_text((DOCS / "conf.py").read_text(encoding="utf-8"))
    (tmp_path / "index.md").write_text("# x\n\n```{toctree}\n:glob:\n*/*\n```\n")
    command = [sys.executable, "-m", "sphinx", "-W", "-q", "-b", "html", str(tmp_path)]
    done = subprocess.run([*command, str(tmp_path / "html")], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    built = (tmp_path / "html" / "reference" / "python_api.html").read_text(encoding="utf-8")
    assert "crowdbot.Session" in built
    assert "https://" not in re.sub(r'<a [^>]*href="https?://[^"]*"', "", built)
    for mark in ('role="heading">', "<pre>", '<aside class="sidebar-drawer">'):
        assert mark not in built, "scripts/accessible_pages.py no longer fits the theme"
