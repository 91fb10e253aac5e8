"""How much faster is this checkout than another one at a campaign?

Both run the same scenarios of the challenge in turns, each time from nothing, in processes of
their own:

    python benchmarks/campaign.py --old ../checkout
    python benchmarks/campaign.py --old ../checkout --repeat 5 --planner goal_seek --jobs 1

The main figure is processor time, user and system, of all processes of a campaign; other work on
the machine changes it least. Prints each campaign and the median of the ratios of neighbours.
Ends with 1 where a trajectory hash or a score differs; scores of wall time are left out.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage
from statistics import median

from campaign_kills import outcome

#: Both flows, all densities, slow and dispersed speeds: 12 scenarios, 12 crowds alone. What
#: ``--set`` lays over scenarios is added to their ids, hence the last star.
TWELVE = "*-*[lp]*-c20-r05*"
SUITE = "challenge-2020"


@dataclass(frozen=True, slots=True)
class Measured:
    """One campaign: processor time, wall time (s), size of its recordings (bytes), its scores."""

    cpu: float
    wall: float
    size: int
    scores: Mapping[str, tuple[str, str]]


@dataclass(frozen=True, slots=True)
class Checkout:
    """A checkout of crowdbot, and the interpreter that runs it."""

    path: Path
    python: str

    @classmethod
    def at(cls, path: Path) -> Checkout:
        """With its own virtual environment where it has one, else with this interpreter."""
        path = path.resolve()
        if not (path / "crowdbot" / "__init__.py").is_file():
            raise SystemExit(f"{path} is not a checkout of crowdbot")
        own = path / ".venv" / "bin" / "python"
        return cls(path, str(own) if own.exists() else sys.executable)

    def translate(self) -> None:
        """Write byte code, which neither side shall have to make while it is measured."""
        command = [self.python, "-m", "compileall", "-qq", str(self.path / "crowdbot")]
        subprocess.run(command, check=True)

    def campaign(self, out: Path, *options: str) -> None:
        """Run one campaign; its output is shown where it fails."""
        command = [self.python, "-m", "crowdbot", "campaign", SUITE, "--record", "used"]
        command += ["--no-floors"] if self.has_floors() else []
        done = subprocess.run(
            [*command, *options, "--quiet", "--out", str(out)],
            cwd=self.path,
            env={**os.environ, "PYTHONPATH": str(self.path)},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        if done.returncode:
            raise SystemExit(f"{self.path}: the campaign failed\n{done.stdout}")

    def has_floors(self) -> bool:
        """Return True if it also runs floors and ceilings; an older checkout knows none."""
        files = (self.path / "crowdbot" / "cli").rglob("campaign.py")
        return any("floors:" in file.read_text() for file in files)

    def measure(self, out: Path, *options: str) -> Measured:
        """Run one campaign, and say what it took."""
        begin, cpu = time.perf_counter(), children_cpu()
        self.campaign(out, *options)
        return Measured(
            cpu=children_cpu() - cpu,
            wall=time.perf_counter() - begin,
            size=sum(file.stat().st_size for file in out.rglob("run.mcap")),
            scores=outcome(out),
        )


def children_cpu() -> float:
    """Processor time of all processes that were started and have ended, s."""
    used = getrusage(RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def in_turns(
    checkouts: Mapping[str, Checkout], options: tuple[str, ...], repeat: int
) -> dict[str, list[Measured]]:
    """Campaigns of each checkout, one after the other, printed as they end."""
    found: dict[str, list[Measured]] = {name: [] for name in checkouts}
    for turn in range(repeat):
        for name, checkout in checkouts.items():
            with tempfile.TemporaryDirectory() as folder:
                one = checkout.measure(Path(folder), *options)
            found[name].append(one)
            print(
                f"{turn + 1:3} {name}: {one.cpu:8.2f} s processor, {one.wall:8.2f} s wall, "
                f"{one.size / 1e6:7.1f} MB recorded, {len(one.scores)} runs",
                flush=True,
            )
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--old", type=Path, required=True, help="a checkout to compare with")
    parser.add_argument(
        "--new", type=Path, default=Path(__file__).parent.parent, help="default: this checkout"
    )
    parser.add_argument("--only", default=TWELVE, help="pattern of scenario ids")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--planner", default="dwa")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--set", action="append", default=[], help="key=value, of each scenario")
    given = parser.parse_args()
    checkouts = {"old": Checkout.at(given.old), "new": Checkout.at(given.new)}
    options = ["--planner", given.planner, "--jobs", str(given.jobs), "--only", given.only]
    options += [word for text in given.set for word in ("--set", text)]
    for checkout in checkouts.values():  # compiles
        checkout.translate()
        with tempfile.TemporaryDirectory() as folder:
            checkout.campaign(Path(folder), *options, "--set", "robots.robot.task.time_limit=2 s")
    found = in_turns(checkouts, tuple(options), given.repeat)
    pairs = list(zip(found["old"], found["new"], strict=True))
    same = all(one.scores == found["old"][0].scores for ones in found.values() for one in ones)
    print(f"old / new, median of {given.repeat}:")
    print(f"  processor time {median(a.cpu / b.cpu for a, b in pairs):.3f}")
    print(f"  wall time      {median(a.wall / b.wall for a, b in pairs):.3f}")
    print(f"  recordings     {median(a.size / b.size for a, b in pairs):.3f}")
    print(f"trajectory hashes and scores: {'all equal' if same else 'DIFFERENT'}")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
