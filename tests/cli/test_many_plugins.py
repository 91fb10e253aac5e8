"""Fifty installed plugin packages: listing them imports none of their build functions."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.plugin_packages import Site, planner

pytestmark = pytest.mark.slow

BUILD = """
from pathlib import Path
Path(__file__).with_suffix(".imported").touch()

def build(spec):
    return spec
"""


def test_listing_fifty_imports_no_build_functions(tmp_path: Path) -> None:
    site = Site(tmp_path)
    for i in range(50):
        name = f"p{i}"
        build = {f"build_{name}": BUILD}
        site.install(name, planner(f"{name}.go", build=f"build_{name}:build"), **build)
    done = site.run("plugins")
    assert done.returncode == 0, done.stderr
    assert done.stdout.count(" ok ") == 51
    assert list(tmp_path.glob("*.imported")) == []


def test_showing_and_validating_import_no_build_functions_either(tmp_path: Path) -> None:
    site = Site(tmp_path)
    site.install("p", planner("p.go", build="build_p:build"), build_p=BUILD)
    assert "built by build_p:build" in site.run("plugins", "show", "p.go").stdout
    assert site.run("schema", "planner").returncode == 0
    assert list(tmp_path.glob("*.imported")) == []
