"""A wheel holds suites, schemas, the cards of metrics and the assets of the replay page."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

from crowdbot import cli
from crowdbot.cli.commands.extend.schema import DocumentKind
from scripts.write_schemas import schema_texts
from tests.paths import ROOT


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
    assert {n for n in names if n.startswith("crowdbot/scenario_specs/schema/")} == {
        f"crowdbot/scenario_specs/schema/{document}.v1.schema.json" for document in DocumentKind
    }


def test_written_schemas_are_those_that_the_command_prints(tmp_path: Path) -> None:
    schemas = schema_texts()
    assert set(schemas) == {f"{document}.v1.schema.json" for document in DocumentKind}
    for name, text in schemas.items():
        document = name.partition(".")[0]
        assert cli.main(["schema", document, "--no-plugins", "--out", str(tmp_path / name)]) == 0
        assert (tmp_path / name).read_text(encoding="utf-8") == text
