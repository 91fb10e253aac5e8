"""What does it cost to notice that a compiled cost function returns NaN?

Makes a copy of crowdbot in which nothing compares costs with themselves, and lets both decide the
same: 250 people in a corridor, seen at moments some tenths of a second apart. Each is loaded by two
processes, so that one can see what a process alone makes; the four take turns, a round of all views
each. Counts processor time of decisions: of each view the least of all rounds. Ends with 1 when
the two decide differently.

    python benchmarks/nan_check.py --rounds 40
"""

from __future__ import annotations

import argparse
import ast
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import mean
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
SEARCH = Path("crowdbot/core/crowd/velocity_search")
#: People, steps of 0.1 s, and of how many of these one is a view.
PEOPLE, STEPS, EVERY = 250, 300, 5
WITH, WITHOUT = "as it is", "without the check"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--rounds", type=int, default=40)
    parser.add_argument("--decide", action="store_true", help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.decide:
        return _decide()
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder)
        shutil.copytree(ROOT / "crowdbot", copy / "crowdbot",
                        ignore=shutil.ignore_patterns("__pycache__"))  # fmt: skip
        left_out = sum(_leave_out(file) for file in (copy / SEARCH).glob("*.py"))
        print(f"{WITHOUT}: a copy of this engine without its {left_out} statements")
        sides = [(name, _start(place))
                 for name, place in ((WITH, ROOT), (WITHOUT, copy)) for _ in range(2)]  # fmt: skip
        equal = [_compare(policy, sides, chosen.rounds) for policy in _policies()]
        for _, process in sides:
            process.communicate("end\n")
    return 0 if all(equal) else 1


# ------------------------------------------------------------------------------ the copy
class _Unchecked(ast.NodeTransformer):
    """Drops what sets ``agent[BROKEN]``, and the question afterwards."""

    count = 0

    def visit_If(self, node: ast.If) -> ast.AST | None:
        """``if math.isnan(...): agent[BROKEN] = 1.0``."""
        self.generic_visit(node)
        if not ast.unparse(node.body[0]).endswith("[BROKEN] = 1.0"):
            return node
        self.count += 1
        return None

    def visit_Expr(self, node: ast.Expr) -> ast.AST | None:
        """``check_numbers(...)``."""
        if not ast.unparse(node).startswith("check_numbers("):
            return node
        self.count += 1
        return None


def _leave_out(file: Path) -> int:
    """Rewrite a file without the check; how many statements went."""
    tree, dropped = ast.parse(file.read_text(encoding="utf-8")), _Unchecked()
    dropped.visit(tree)
    if dropped.count:
        file.write_text(ast.unparse(tree) + "\n", encoding="utf-8")
    return dropped.count


# ---------------------------------------------------------------------------- both sides
def _start(place: Path) -> subprocess.Popen[str]:
    threads = dict.fromkeys(("OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    return subprocess.Popen(
        [sys.executable, __file__, "--decide"], text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        env=os.environ | threads | {"PYTHONPATH": os.pathsep.join((str(place), str(ROOT)))},
    )  # fmt: skip


def _policies() -> list[str]:
    from original_steps import FIGURES

    return list(FIGURES)


def _compare(policy: str, sides: list[tuple[str, subprocess.Popen[str]]], rounds: int) -> bool:
    """Print the ratio of one policy; whether both decided the same."""
    least: list[list[float]] = [[] for _ in sides]
    for _, process in sides:
        _ask(process, policy)  # compiles
    same = True
    for number in range(rounds):
        digests = set()
        order = range(len(sides)) if number % 2 == 0 else reversed(range(len(sides)))
        for n in order:
            digest, *spent = _ask(sides[n][1], "again")
            digests.add(digest)
            found = [float(s) for s in spent]
            least[n] = [min(pair) for pair in zip(least[n] or found, found, strict=True)]
        same = same and len(digests) == 1
    times = [1000.0 * mean(views) for views in least]
    first, second = times[:2], times[2:]
    ratio = sum(first) / sum(second)
    print(
        f"{policy}, ms for a decision of {PEOPLE} people: "
        f"{WITH} {first[0]:.4f} and {first[1]:.4f}, {WITHOUT} {second[0]:.4f} and {second[1]:.4f}; "
        f"the check costs {100.0 * (ratio - 1.0):+.2f} %; "
        f"{'equal' if same else 'other'} decisions; load {os.getloadavg()[0]:.0f}",
        flush=True,
    )
    return same


def _ask(process: subprocess.Popen[str], line: str) -> list[str]:
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write(line + "\n")
    process.stdin.flush()
    answer = process.stdout.readline().split()
    if not answer:
        sys.exit(f"a process ended with {process.wait()}")
    return answer


def _decide() -> int:
    """Answer each line with a digest of all decisions, and the time of each."""
    import numpy as np
    from crowd import people
    from original_steps import FIGURES, whole_step

    from crowdbot.core.crowd import policy_of
    from crowdbot.core.crowd.desired_acceleration import desired_acceleration

    agents, walls = people(PEOPLE)
    for line in iter(sys.stdin.readline, "end\n"):
        if line.strip() in FIGURES:
            seen: list[Any] = []
            policy, costs, _, _ = FIGURES[line.strip()]
            step = whole_step(policy, costs, agents, walls, seen)
            for _ in range(STEPS):
                step()
            views, chosen = seen[::EVERY], policy_of(policy, costs)(agents)
        digest, spent = hashlib.sha256(), []
        for view in views:
            begin = time.process_time()
            found = desired_acceleration(chosen, view)
            spent.append(time.process_time() - begin)
            digest.update(np.ascontiguousarray(found).tobytes())
        print(digest.hexdigest(), *spent, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
