"""Fifty installed plugin packages: listing them is quick and imports none of their deeds."""

from __future__ import annotations

import resource
from pathlib import Path

from plugin_packages import Site, planner

DEEDS = """
import time
from pathlib import Path
Path(__file__).with_suffix(".imported").touch()
time.sleep(1.0)

def build(spec):
    return spec
"""


def test_listing_fifty_imports_no_deeds_and_is_quick(tmp_path: Path) -> None:
    site = Site(tmp_path)
    for i in range(50):
        name = f"p{i}"
        deeds = {f"deeds_{name}": DEEDS}
        site.install(name, planner(f"{name}.go", build=f"deeds_{name}:build"), **deeds)
    assert site.run("plugins").returncode == 0  # compiles
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = site.run("plugins")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert done.stdout.count(" ok ") == 51
    assert list(tmp_path.glob("*.imported")) == []
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < 1.0


def test_showing_and_validating_import_no_deeds_either(tmp_path: Path) -> None:
    site = Site(tmp_path)
    site.install("p", planner("p.go", build="deeds_p:build"), deeds_p=DEEDS)
    assert "built by deeds_p:build" in site.run("plugins", "show", "p.go").stdout
    assert site.run("schema", "planner").returncode == 0
    assert list(tmp_path.glob("*.imported")) == []
