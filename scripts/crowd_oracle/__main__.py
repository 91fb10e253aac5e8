"""Compare our crowd engine with recorded steps of the original one.

``python -m scripts.crowd_oracle FOLDER [--json] [--case NAME ...]`` replays every case of
a folder of ``NAME.json`` and ``NAME.npz`` files one step at a time, with the original's defects
switched on, and prints residuals, ties and misses. Exit code 1 if there is a miss or a case that
cannot be read, 2 for wrong usage.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from scripts.crowd_oracle.case import load
from scripts.crowd_oracle.judge import Verdict, judge

_HEADER = (
    f"{'case':42} {'samples':>8} {'outright':>9} {'perturbed':>9} {'by cost':>8} "
    f"{'rounding':>8} {'misses':>7} {'NaN':>5} {'median':>8} {'p99':>8}"
)


def cases(folder: Path) -> list[str]:
    """Return the names of the cases in a folder."""
    return sorted(p.stem for p in folder.glob("*.npz") if p.with_suffix(".json").exists())


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m scripts.crowd_oracle",
        description="Replay recorded steps of the original crowd engine.",
    )
    parser.add_argument("folder", type=Path, help="folder of NAME.json and NAME.npz files")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    parser.add_argument("--case", action="append", default=[], help="only this case; repeatable")
    given = parser.parse_args(arguments)
    names = given.case or cases(given.folder)
    if not names:
        print(f"{given.folder}: no cases (NAME.npz with NAME.json)", file=sys.stderr)
        return 1
    verdicts: list[Verdict] = []
    errors: dict[str, str] = {}
    if not given.json:
        print(_HEADER)
    for name in names:
        try:
            verdict = judge(load(given.folder, name))
        except (OSError, ValueError, KeyError) as error:
            errors[name] = f"{type(error).__name__}: {error}"
            print(f"{name}: {errors[name]}", file=sys.stderr)
            continue
        verdicts.append(verdict)
        if not given.json:
            print(_line(verdict), flush=True)
    _finish(verdicts, errors, as_json=given.json)
    return 1 if errors or any(v.misses for v in verdicts) else 0


def _line(v: Verdict) -> str:
    return (
        f"{v.name:42} {v.samples:8d} {v.outright:9d} {v.by_perturbation:9d} {v.by_cost:8d} "
        f"{v.by_rounding:8d} {v.misses:7d} {v.not_a_number:5d} {v.median:8.1e} {v.p99:8.1e}"
    )


def _finish(verdicts: list[Verdict], errors: dict[str, str], *, as_json: bool) -> None:
    samples, outright = sum(v.samples for v in verdicts), sum(v.outright for v in verdicts)
    misses = sum(v.misses for v in verdicts)
    if as_json:
        document = {
            "cases": [v.as_dict() for v in verdicts],
            "errors": errors,
            "samples": samples,
            "outright": outright,
            "misses": misses,
        }
        print(json.dumps(document, indent=1))
        return
    share = 100.0 * outright / samples if samples else 0.0
    print(
        f"{len(verdicts)} cases, {samples} samples, {share:.3f} % outright, {misses} misses, "
        f"{len(errors)} unreadable"
    )


if __name__ == "__main__":
    raise SystemExit(main())
