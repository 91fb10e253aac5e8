"""``crowdbot plugins`` with many installed plugin packages, beside the same without any.

Each package has a module of words with a spec, and a module of deeds that sleeps for a second
when it is imported. Run: ``python benchmarks/plugin_listing.py [PACKAGES]``.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

INIT = '''"""A plugin."""
from crowdbot.plugin import hookimpl
CROWDBOT_API = 1
@hookimpl
def crowdbot_components():
    return {{"planner": ["{module}.words:PLANNER"]}}
'''
WORDS = '''"""Words."""
from typing import Literal
from pydantic import Field
from crowdbot.plugin import Component, PlannerSpec, PositiveLength, PositiveSpeed
class Spec(PlannerSpec):
    """A planner."""
    kind: Literal["{name}.go"] = "{name}.go"
    gap: PositiveLength = Field(default=0.5, description="Gap, m.")
    speed: PositiveSpeed = Field(default=0.5, description="Speed, m/s.")
    tries: int = Field(default=3, description="Number of tries.")
PLANNER = Component(spec=Spec, build="{module}.deeds:build", summary="goes")
'''
DEEDS = '"""Deeds."""\nimport time\ntime.sleep(1.0)\ndef build(spec): return spec\n'
MAIN = "import sys; from crowdbot.cli import main; sys.exit(main())"


def install(folder: Path, count: int) -> None:
    """Packages as pip leaves them."""
    for i in range(count):
        name, module = f"p{i:02d}", f"bench_p{i:02d}"
        package = folder / module
        package.mkdir(parents=True)
        (package / "__init__.py").write_text(INIT.format(module=module), encoding="utf-8")
        (package / "words.py").write_text(WORDS.format(name=name, module=module), encoding="utf-8")
        (package / "deeds.py").write_text(DEEDS, encoding="utf-8")
        info = folder / f"bench_{name}-1.0.dist-info"
        info.mkdir()
        head = f"Metadata-Version: 2.1\nName: bench-{name}\nVersion: 1.0\n"
        (info / "METADATA").write_text(head, encoding="utf-8")
        (info / "entry_points.txt").write_text(f"[crowdbot]\n{name} = {module}\n", encoding="utf-8")


def listing(folder: Path) -> tuple[float, float]:
    """Wall and CPU time of one listing, s."""
    env = {**os.environ, "PYTHONPATH": str(folder)}
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.perf_counter()
    subprocess.run(
        [sys.executable, "-c", MAIN, "plugins"], env=env, check=True, capture_output=True
    )
    wall = time.perf_counter() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - used.ru_utime - used.ru_stime


def best(count: int, rounds: int = 7) -> dict[int, tuple[float, float]]:
    """Best times with no package and with ``count`` of them, measured in turn."""
    with tempfile.TemporaryDirectory() as text:
        folders = {n: Path(text) / str(n) for n in (0, count)}
        for number, folder in folders.items():
            folder.mkdir()
            install(folder, number)
            listing(folder)  # compiles
        times: dict[int, list[tuple[float, float]]] = {0: [], count: []}
        for _ in range(rounds):
            for number, folder in folders.items():
                times[number].append(listing(folder))
    return {n: (min(w for w, _ in t), min(c for _, c in t)) for n, t in times.items()}


def main() -> None:
    """Print both, and their ratio."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 50
    found = best(count)
    for number, (wall, cpu) in found.items():
        print(f"{number:3d} packages: {wall:.3f} s, {cpu:.3f} s of CPU time")
    print(f"ratio of CPU times: {found[count][1] / found[0][1]:.2f}")


if __name__ == "__main__":
    main()
