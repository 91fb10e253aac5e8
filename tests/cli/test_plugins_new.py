"""``crowdbot plugins new``: the package works as it is written; names are looked at."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from crowdbot.cli import main
from tests.cli.plugin_packages import Site

pytestmark = pytest.mark.slow

Captured = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("new") / "crowdbot-my_lab"
    assert main(["plugins", "new", "my_lab", "--out", str(folder)]) == 0
    return folder


@pytest.fixture(scope="module")
def site(project: Path) -> Site:
    """The package, built and installed as pip does it."""
    folder = project.parent / "site"
    python = [sys.executable, "-m"]
    subprocess.run(
        [*python, "hatchling", "build", "-t", "wheel"], cwd=project, check=True, capture_output=True
    )
    (wheel,) = project.glob("dist/crowdbot_my_lab-0.1.0-*.whl")
    install = ["pip", "install", "--no-deps", "--no-index", "--target", str(folder), str(wheel)]
    subprocess.run([*python, *install], check=True, capture_output=True)
    return Site(folder)


def test_all_that_was_promised_is_there(project: Path) -> None:
    names = {p.relative_to(project).as_posix() for p in project.rglob("*") if p.is_file()}
    assert {"pyproject.toml", ".github/workflows/ci.yml", "tests/test_conformance.py"} <= names
    assert "crowdbot_my_lab/cards/pauses.md" in names
    text = "".join((project / n).read_text() for n in names if not n.startswith("dist/"))
    assert "$" not in text.replace("${{ matrix", "")
    assert ".tmpl" not in text
    assert not list(project.parent.glob(".*"))


def test_the_installed_package_is_listed_whole(site: Site) -> None:
    (plugin,) = site.plugins()["my_lab"]
    assert plugin["state"] == "ok", plugin["error"]
    assert plugin["distribution"] == "crowdbot-my-lab 0.1.0"
    assert set(plugin["provides"]) == {
        "robot", "sensor", "planner", "crowd policy", "cost function", "metric",
    }  # fmt: skip
    assert site.run("validate", "my_lab:first").returncode == 0


def test_the_package_keeps_its_promises(site: Site, project: Path) -> None:
    """Its own tests: conformance, and a short run."""
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(project)],
        env={**os.environ, "PYTHONPATH": str(site.folder)}, cwd=project, check=False,
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout
    assert "failed" not in done.stdout


def test_the_other_scenario_runs(site: Site) -> None:
    options = ["--planner", "my_lab.wander", "--set", "robots.robot.task.time_limit=1 s"]
    done = site.run("simulate", "my_lab:first", "choosing", *options, "--no-references", "--all")
    assert done.returncode == 0, done.stderr
    assert "my_lab.pauses" in done.stdout
    assert "pinned" not in done.stdout


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("My-Lab", "'my_lab' would do"),
        ("3d", "'d' would do"),
        ("a.b", "'a_b' would do"),
        ("../x", "is not a name"),
        ("", "is not a name"),
        ("builtin", "cannot be the name of a plugin"),
        ("class", "cannot be the name of a plugin"),
    ],
)
def test_names_that_will_not_do(
    name: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["plugins", "new", name]) == 1
    assert message in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_name_that_is_taken(site: Site) -> None:
    done = site.run("plugins", "new", "my_lab")
    assert done.returncode == 1
    assert "'my_lab' is the name of a plugin of crowdbot-my-lab 0.1.0 already" in done.stderr


def test_what_is_there_is_left_alone(tmp_path: Path, capsys: Captured) -> None:
    (tmp_path / "here").write_text("mine")
    for out in (tmp_path, tmp_path / "here"):
        assert main(["plugins", "new", "lab", "--out", str(out)]) == 1
        assert "exists already" in capsys.readouterr().err
    assert (tmp_path / "here").read_text() == "mine"
    assert main(["plugins", "new", "lab", "--out", "/dev/null/x"]) == 1
    assert "cannot be written" in capsys.readouterr().err
