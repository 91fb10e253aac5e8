"""Packages of plugins as pip leaves them: a module and a dist-info folder, put on a path."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

MAIN = "import sys; from crowdbot.cli import main; sys.exit(main())"
HEAD = """
from typing import Any, ClassVar, Literal
from pydantic import Field, field_validator
from crowdbot.plugin import Component
from crowdbot.plugin import PlannerSpec, RobotSpec
from crowdbot.plugin import hookimpl
CROWDBOT_API = 1
"""
PLANNER = """
class Spec(PlannerSpec):
    \"\"\"A planner.\"\"\"
    kind: Literal["{kind}"] = "{kind}"
    gain: float = Field(default=1.0, description="Gain, 1/s.")

PLANNER = Component(spec=Spec, build="{build}", summary="drives")

@hookimpl
def crowdbot_components():
    return {{"planner": [PLANNER]}}
"""


def planner(kind: str, build: str = "nowhere:build") -> str:
    """Text of a module with one planner."""
    return HEAD + PLANNER.format(kind=kind, build=build)


@dataclass(frozen=True)
class Site:
    """A folder of installed packages."""

    folder: Path

    def install(
        self, name: str, text: str, *, entry: str | None = None, version: str = "0.3", **more: str
    ) -> None:
        """A distribution ``crowdbot-NAME`` with a module ``plugin_NAME``; more modules by name."""
        module = f"plugin_{name}"
        for file, content in {module: text, **more}.items():
            (self.folder / f"{file}.py").write_text(content, encoding="utf-8")
        self.declare(f"crowdbot-{name}", f"{entry or name} = {module}", version)

    def declare(self, distribution: str, entry: str, version: str = "0.3") -> None:
        """Only what pip writes about a distribution."""
        info = self.folder / f"{distribution.replace('-', '_')}-{version}.dist-info"
        info.mkdir(parents=True)
        head = f"Metadata-Version: 2.1\nName: {distribution}\nVersion: {version}\n"
        (info / "METADATA").write_text(head, encoding="utf-8")
        (info / "entry_points.txt").write_text(f"[crowdbot]\n{entry}\n", encoding="utf-8")

    def run(self, *words: str, **environment: str) -> subprocess.CompletedProcess[str]:
        """A command in a process that has the packages installed."""
        paths = os.pathsep.join([str(self.folder), environment.pop("more_paths", "")])
        paths = paths.strip(os.pathsep)
        env = {**os.environ, "PYTHONPATH": paths, "COLUMNS": "400", **environment}
        command = [sys.executable, "-c", MAIN, *words]
        done = subprocess.run(
            command, env=env, cwd=self.folder, capture_output=True, text=True, check=False
        )
        assert "Traceback" not in done.stdout or "--json" in words, done.stdout
        return done

    def plugins(self, *words: str, **environment: str) -> dict[str, list[dict[str, Any]]]:
        """Plugins by name, as ``crowdbot plugins --json`` lists them."""
        done = self.run("plugins", "--json", *words, **environment)
        assert done.returncode == 0, done.stderr
        found: dict[str, list[dict[str, Any]]] = {}
        for plugin in json.loads(done.stdout):
            found.setdefault(plugin["name"], []).append(plugin)
        return found
