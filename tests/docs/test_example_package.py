"""A third party's day: wheels in a fresh environment, and everything works from there."""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.paths import ROOT

pytestmark = pytest.mark.slow

EXAMPLE = ROOT / "docs/examples/crowdbot-acme"
TUTORIAL = ROOT / "docs/tutorial/files/crowdbot-careful"


@dataclass(frozen=True)
class Site:
    """A fresh environment with the wheels, and an empty folder to work in."""

    python: Path
    work: Path

    def run(self, *argv: str | Path) -> subprocess.CompletedProcess[str]:
        """Run ``python -m ...`` away from the checkout."""
        kept = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME")}
        return subprocess.run(
            [str(self.python), "-m", *map(str, argv)],
            cwd=self.work,
            env={**kept, "NUMBA_CACHE_DIR": str(self.work / "kernels")},
            capture_output=True,
            text=True,
            check=False,
        )

    def crowdbot(self, *words: str | Path) -> str:
        """Standard output of a command that must succeed."""
        done = self.run("crowdbot", *words)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Site:
    folder = tmp_path_factory.mktemp("site")
    wheels = [_wheel(source, folder / "wheels") for source in (ROOT, EXAMPLE, TUTORIAL)]
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder / "venv"], check=True)
    python = folder / "venv/bin/python"
    install = [sys.executable, "-m", "pip", "--python", str(python), "install", "--quiet"]
    offline = ["--no-index", "--no-deps", "--no-compile", "--disable-pip-version-check"]
    subprocess.run([*install, *offline, *wheels], check=True)
    work = folder / "work"
    work.mkdir()
    where = "import sysconfig; print(sysconfig.get_path('purelib'))"
    found = subprocess.run([python, "-c", where], capture_output=True, text=True, check=True)
    # What both depend on comes from here; a folder named in a .pth file comes after the wheels.
    parent = {sysconfig.get_path(p) for p in ("purelib", "platlib")}
    Path(found.stdout.strip(), "dependencies.pth").write_text("\n".join(parent), encoding="utf-8")
    return Site(python, work)


def _wheel(source: Path, into: Path) -> Path:
    before = set(into.glob("*.whl"))
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(into)]
    subprocess.run(command, cwd=source, check=True, capture_output=True)
    (wheel,) = set(into.glob("*.whl")) - before
    return wheel


def test_the_wheels_are_what_runs(site: Site) -> None:
    done = site.run("crowdbot", "--version")
    assert done.returncode == 0, done.stderr
    code = "import crowdbot, crowdbot_acme; print(crowdbot.__file__, crowdbot_acme.__file__)"
    found = subprocess.run(
        [site.python, "-c", code], cwd=site.work, capture_output=True, text=True, check=True
    )
    for file in found.stdout.split():
        assert Path(file).is_relative_to(site.python.parent.parent), file


def test_the_plugin_is_listed(site: Site) -> None:
    found = {p["name"]: p for p in json.loads(site.crowdbot("plugins", "--json"))}
    acme = found["acme"]
    assert acme["state"] == "ok", acme["error"]
    assert acme["distribution"] == "crowdbot-acme 0.2.0"
    assert acme["pinned"] is True
    wanted = {
        "environment", "robot", "sensor", "noise", "planner", "crowd policy", "cost function",
        "metric",
    }  # fmt: skip
    assert set(acme["provides"]) == wanted
    assert found["builtin"]["distribution"].startswith("crowdbot ")


def test_the_suite_validates_and_expands(site: Site) -> None:
    site.crowdbot("validate", "acme:office")
    names = [line.split()[0] for line in site.crowdbot("expand", "acme:office").splitlines()]
    assert names == ["cart-drift", "cart-costs", "glider-drift", "glider-costs"]


def test_the_suite_can_be_locked(site: Site) -> None:
    copy = site.work / "office.yaml"
    shutil.copy(EXAMPLE / "crowdbot_acme/suites/office.yaml", copy)
    site.crowdbot("lock", copy)
    assert (site.work / "office.lock.json").is_file()
    site.crowdbot("lock", copy, "--check")
    copy.write_text(copy.read_text(encoding="utf-8").replace("1.1 m/s", "1.2 m/s"))
    assert site.run("crowdbot", "lock", copy, "--check").returncode == 1


def test_its_planner_drives_and_its_metric_scores(site: Site) -> None:
    text = site.crowdbot(
        "simulate", "acme:office", "glider-drift", "--planner", "acme.swerve", "--json", "--quiet",
        "--record", "used", "--set", "robots.robot.task.time_limit=3", "--no-references",
    )  # fmt: skip
    record = json.loads(text)
    assert record["status"] == "timeout"
    assert {p["name"] for p in record["plugins"]} >= {"acme", "builtin"}
    with (site.work / record["directory"] / "scores.csv").open(newline="") as table:
        rows = {(r["metric"], r["variant"]): r for r in csv.DictReader(table)}
    row = rows["acme.hesitation", "share"]
    assert row["status"] == "ok"
    assert 0.0 <= float(row["value"]) <= 1.0


def test_the_planner_of_the_tutorial(site: Site) -> None:
    text = site.crowdbot(
        "simulate", "acme:office", "cart-drift", "--planner", "careful.waiter", "--json", "--quiet",
        "--record", "used", "--no-references", "--set", "robots.robot.task.time_limit=1",
    )  # fmt: skip
    record = json.loads(text)
    assert record["status"] == "timeout"
    assert record["pinned"] is True
    assert "crowdbot-careful 0.1.0" in {p["distribution"] for p in record["plugins"]}


@pytest.mark.parametrize("package", [EXAMPLE, TUTORIAL], ids=lambda p: p.name)
def test_its_own_tests_pass(package: Path, site: Site) -> None:
    tests = site.work / package.name
    shutil.copytree(package / "tests", tests)
    shutil.copy(package / "pyproject.toml", tests)
    done = site.run("pytest", "-q", "-p", "no:cacheprovider", tests)
    assert done.returncode == 0, done.stdout[-4000:]
    assert "skipped" not in done.stdout


def test_the_planner_that_does_not_clamp(site: Site) -> None:
    """What the tutorial says about leaving one line out."""
    page = (ROOT / "docs/tutorial/package_a_planner.md").read_text(encoding="utf-8")
    broken = site.work / "broken"
    shutil.copytree(TUTORIAL, broken)
    module = broken / "crowdbot_careful/waiter_build.py"
    text = module.read_text(encoding="utf-8")
    line = "        w = max(-self.limits.w_max, min(self.limits.w_max, 2.0 * error))\n"
    assert line in text
    module.write_text(text.replace(line, "        w = 2.0 * error\n"), encoding="utf-8")
    test = "tests/test_waiter.py::test_conformance[careful.waiter-check_commands_are_within_limits]"
    code = f"import sys, pytest; sys.path.insert(0, {str(broken)!r}); pytest.main(['-q', {test!r}])"
    done = subprocess.run(
        [site.python, "-c", code], cwd=broken, capture_output=True, text=True, check=False
    )
    found = re.search(r"AssertionError: (.*) commands were beyond the limits", done.stdout)
    assert found, done.stdout
    assert f'"{found[1]} commands were beyond the limits"' in page
