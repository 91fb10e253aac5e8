"""``--plugin``: files, package folders and projects; what is checked and shown of them."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from tests.cli.plugin_packages import Site, planner

pytestmark = pytest.mark.slow

ENTRY = '[project]\nname = "crowdbot-acme"\n[project.entry-points.crowdbot]\nacme = "acme_go"\n'
MODULE = """
from crowdbot.plugin import Command

class Go:
    def __init__(self, spec): pass
    def reset(self, task, limits, sensors, seed): pass
    def step(self, obs): return Command(0.1, 0.0)
"""


def write(folder: Path, *, source: str = "", entry: str = ENTRY) -> Path:
    """A project with a package ``acme_go``."""
    package = folder / source / "acme_go"
    package.mkdir(parents=True)
    (folder / "pyproject.toml").write_text(entry, encoding="utf-8")
    text = planner("acme.go", build="acme_go.go_build:Go")
    (package / "__init__.py").write_text(text, encoding="utf-8")
    (package / "go_build.py").write_text(MODULE, encoding="utf-8")
    return folder


@pytest.fixture
def site(tmp_path: Path) -> Site:
    (tmp_path / "site").mkdir()
    return Site(tmp_path / "site")


@pytest.mark.parametrize(("source", "inside"), [("", False), ("src", True)])
def test_a_project_or_its_package(source: str, inside: bool, site: Site, tmp_path: Path) -> None:
    project = write(tmp_path / "p", source=source)
    path = project / source / "acme_go" if inside else project
    (plugin,) = site.plugins("--plugin", str(path))["acme"]
    assert (plugin["state"], plugin["pinned"]) == ("ok", False), plugin["error"]
    assert plugin["distribution"] == str(path)
    done = site.run("plugins", "check", "--plugin", str(path))
    assert done.returncode == 0, done.stdout
    assert "given by --plugin, not installed" in done.stdout


def test_a_package_folder_alone_is_called_by_its_name(site: Site, tmp_path: Path) -> None:
    package = tmp_path / "crowdbot_lone"
    package.mkdir()
    (package / "__init__.py").write_text(planner("lone.go"))
    assert site.plugins("--plugin", str(package))["lone"][0]["state"] == "ok"


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("[project]\nname = 'x'\n", "declares no plugin"),
        ("= 3", "cannot be read"),
        (ENTRY.replace("acme_go", "elsewhere"), "no module 'elsewhere'"),
        (ENTRY.replace("acme_go", "acme_go:nothing"), "has no attribute 'nothing'"),
    ],
)
def test_projects_without_a_plugin(entry: str, message: str, site: Site, tmp_path: Path) -> None:
    project = write(tmp_path / "p", entry=entry)
    done = site.run("validate", "challenge-2020", "--plugin", str(project))
    assert done.returncode == 3
    assert message in done.stderr
    assert done.stderr.startswith("error: --plugin ")
    assert site.run("plugins", "--plugin", str(project)).returncode == 0


def test_a_path_that_is_not_there(site: Site) -> None:
    done = site.run("plugins", "--plugin", "nowhere")
    assert done.returncode == 1
    assert done.stderr == "error: --plugin nowhere: no such file or folder\n"


def test_a_plugin_that_is_installed_from_the_same_files(site: Site, tmp_path: Path) -> None:
    """As with ``pip install -e``: one plugin, no collision."""
    project = write(tmp_path / "p")
    site.declare("crowdbot-acme", "acme = acme_go")
    found = site.plugins("--plugin", str(project), more_paths=str(project))["acme"]
    assert [(p["state"], p["pinned"]) for p in found] == [("ok", False)]
    (installed,) = site.plugins(more_paths=str(project))["acme"]
    assert installed["file"] == str(project / "acme_go" / "__init__.py")
    other = write(tmp_path / "other")
    both = site.plugins("--plugin", str(other), more_paths=str(project))["acme"]
    assert all("E301" in p["error"] and str(other) in p["error"] for p in both)


def test_no_plugins_leaves_those_given_by_hand(site: Site, tmp_path: Path) -> None:
    site.install("one", planner("one.go"))
    found = site.plugins("--no-plugins", "--plugin", str(write(tmp_path / "p")))
    assert {n: p[0]["state"] for n, p in found.items()} == {
        "acme": "ok",
        "builtin": "ok",
        "one": "off",
    }


def test_a_failing_check_fails_the_command(site: Site, tmp_path: Path) -> None:
    file = tmp_path / "acme.py"
    text = planner("acme.go", build="acme:nothing").replace('"Gain, 1/s."', '"Gain"')
    file.write_text(text)
    done = site.run("plugins", "check", "acme.go", "--plugin", str(file), "--json")
    assert done.returncode == 1
    found = {r["check"]: r for r in json.loads(done.stdout)}
    assert found["check_examples_validate"]["result"] == "passed"
    assert found["check_entry_point_yields_it"]["result"] == "skipped"
    for check, reason in (
        ("check_fields_are_described", "field 'gain' has no unit"),
        ("check_build_resolves", "build 'acme:nothing' not found"),
    ):
        assert found[check]["result"] == "failed"
        assert reason in found[check]["reason"]
        assert found[check]["advice"]


def test_without_pytest_the_checks_say_what_is_missing(site: Site) -> None:
    """Or they need none: then they pass."""
    (site.folder / "pytest.py").write_text("raise ModuleNotFoundError(name='pytest')")
    done = site.run("plugins", "check", "goal_seek")
    assert done.returncode == 0 or "pip install 'crowdbot[testing]'" in done.stderr
    assert os.linesep not in done.stderr.rstrip()


def test_nothing_to_check(site: Site) -> None:
    assert site.run("plugins", "check").returncode == 2
    done = site.run("plugins", "check", "goal_sek")
    assert done.returncode == 1
    assert "did you mean 'goal_seek'" in done.stderr
