"""A built wheel holds the suites, the cards of metrics and the assets of the replay page."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

from tests.paths import ROOT

ROOT = ROOT


def test_the_wheel_is_complete(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    names = set(zipfile.ZipFile(wheel).namelist())
    for source in (ROOT / "crowdbot").rglob("*"):
        if source.is_file() and "__pycache__" not in source.parts:
            assert source.relative_to(ROOT).as_posix() in names
    for card in (ROOT / "docs/reference/metrics").glob("*.md"):  # linked into the package
        assert f"crowdbot/plugins/metrics/cards/{card.name}" in names
    for suite in (ROOT / "scenario_specs").rglob("*.yaml"):
        assert f"crowdbot/{suite.relative_to(ROOT).as_posix()}" in names
