"""Writes what is known of the crowds that come with crowdbot: a page, and numbers for reports.

    python scripts/write_crowd_validation.py [--seeds 1..3] [NAME...]

Simulates each named crowd (and those of the two challenges) where people were recorded, and writes
docs/reference/crowd/validation.md and crowdbot/core/realism/known_crowds.json, crowd by crowd. With
names only these are simulated, in that order; the others keep what was written before.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.realism.crowds import KNOWN
from crowdbot.core.realism.measure import SEEDS, Realism, measure
from crowdbot.core.realism.model import model_of
from crowdbot.core.realism.reference import FLOORS, RealismReference, shipped
from crowdbot.core.realism.statistics import PERCENTILES
from crowdbot.core.realism.tables import real_beside
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.scenarios.named_crowds import crowd_parts, open_crowd
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.dsl.identity.crowd_likeness import fingerprint
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.errors import UnknownNameError

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "reference" / "crowd" / "validation.md"
NUMBERS = ROOT / "crowdbot" / "core" / "realism" / KNOWN
#: Suites whose own crowds are measured as they are there.
SUITES = {"challenge-2026": "challenge-2026"}
#: The crowd of challenge-2020 with the bodies it has there, and the speeds of real people.
MIX, SPEEDS = "challenge_2020", ["speed.mean=1.34 m/s", "speed.std=0.26 m/s", "body.radius=0.33 m"]
#: Copies of people without avoidance that are listed beside the crowds.
_NOBODY = "people who do not avoid each other"


def crowds(registry: Registry) -> Iterator[tuple[str, Crowd]]:
    """Name and crowd of all that is listed."""
    for name in crowd_parts(registry):
        yield name, open_crowd(name, registry)
    yield "challenge mix", open_crowd(MIX, registry, SPEEDS)
    for suite, name in SUITES.items():
        crowd = open_spec(suite, registry).scenarios[0].crowd
        if crowd is not None:
            yield name, crowd


def row_of(name: str, found: Realism) -> dict[str, Any]:
    """What is kept of one crowd."""
    data = found.as_json()
    kept = ("score", "index", "ceiling", "floor", "parts", "beside", "lane_order", "nearest_m")
    acceleration = {
        "/".join(c): round(float(np.nanmedian(rows[:, 2])), 3)
        for c, rows in found.statistics.people.items()
    }
    return {
        "name": name,
        **{key: data[key] for key in kept},
        "fundamental_diagram": data["fundamental_diagram"],
        "acceleration_median": acceleration,
    }


def page(rows: Sequence[dict[str, Any]], reference: RealismReference) -> str:
    """The page in Markdown."""
    ordered = sorted(rows, key=lambda r: -r["score"])
    real = real_beside(reference)
    lines = [
        "# Validation of the crowds",
        "",
        "This page compares every crowd that comes with crowdbot with people who were recorded in "
        "corridors; [realism](../realism.md) explains the columns. Written by "
        "`scripts/write_crowd_validation.py`; `crowdbot realism NAME --out page.html` shows the "
        "curves of one of them.",
        "",
        "Named crowds have no bodies and speeds of their own unless the part says so: people of "
        "0.2 m radius who prefer 1.5 m/s. `challenge mix` is `challenge_2020` with people "
        "of 0.33 m who prefer 1.34 ± 0.26 m/s, `challenge-2026` is the crowd of that suite: "
        "`calibrated`, with a larger spread of speeds and accelerations up to 3 m/s². "
        "`demo_2` equals `social_forces`: they differ only in ranges beyond which people have "
        "no influence ([named policies](named_policies.md)). `dutra`, `foe_avoidance` and `paris`, "
        "which have limits of legs, were measured in three draws, the others in sixteen.",
        "",
        *_table(
            ["crowd", "index", "score", "speed", "acceleration", "turning", "nearest",
             "time to collision"],
            [_features("recorded people", 1.0, reference.ceiling.score, reference.ceiling.parts)]
            + [_features(r["name"], r["index"], r["score"], r["parts"]) for r in ordered]
            + [_features(_NOBODY, 0.0, reference.floor.score, reference.floor.parts)],
        ),
        "",
        "Errors beside the recordings: of speed over density, of the lane order, of the nearest "
        "distances, of the pair correlation; and the share of person-time in which bodies overlap.",
        "",
        *_table(
            ["crowd", "fundamental diagram", "lane order", "1 % nearest, m", "50 % nearest, m",
             "pair correlation", "overlap"],
            [["recorded people", f"{real.diagram_error:.3f}", f"{real.lane_error:.3f}",
              f"{real.nearest_error[0]:.3f}", f"{real.nearest_error[2]:.3f}",
              f"{real.pair_error:.3f}", "–"]]
            + [_errors(r) for r in ordered],
        ),
        "",
        "Speed in one direction and lane order in counterflow:",
        "",
        *_table(
            ["crowd", "0.2/m²", "1.0/m²", "2.0/m²", "lanes 0.9/m²", "lanes 2.0/m²",
             "median acceleration 1.4/m², m/s²"],
            [_curve("recorded people", reference.whole.diagram["uni"].tolist(),
                    {"/".join(c): [v, v] for c, v in reference.whole.lanes.items()},
                    _median_acceleration(reference))]
            + [_curve(r["name"], r["fundamental_diagram"].get("uni", []), r["lane_order"],
                      r["acceleration_median"].get("uni/1.4")) for r in ordered],
        ),
        "",
    ]  # fmt: skip
    return "\n".join(lines)


def _features(name: str, index: float, score: float, parts: Any) -> list[str]:
    order = ("speed", "acceleration", "turning", "nearest", "time_to_collision")
    return [name, f"{index:.2f}", f"{score:.3f}", *(f"{parts[f]:.2f}" for f in order)]


def _errors(row: dict[str, Any]) -> list[str]:
    b = row["beside"]
    near = b["nearest_error_m"]
    values = [
        b["fundamental_diagram_error"], b["lane_order_error"], near[0], near[len(PERCENTILES) - 1],
        b["pair_correlation_error"],
    ]  # fmt: skip
    overlap = b["overlap"]
    return [
        row["name"],
        *("–" if v is None else f"{v:.3f}" for v in values),
        "–" if overlap is None else f"{100 * overlap:.2f} %",
    ]


def _curve(name: str, diagram: Any, lanes: Any, acceleration: float | None) -> list[str]:
    curve = np.array(diagram, np.float64).reshape(-1, 2)
    speeds = [
        "–" if len(curve) < 2 else f"{float(np.interp(d, curve[:, 0], curve[:, 1])):.2f}"
        for d in (0.2, 1.0, 2.0)
    ]
    own = [lanes.get(f"counter/{d}", [None])[0] for d in ("0.9", "2.0")]
    return [
        name,
        *speeds,
        *("–" if v is None else f"{v:.2f}" for v in own),
        "–" if acceleration is None else f"{acceleration:.2f}",
    ]


def _median_acceleration(reference: RealismReference) -> float:
    from crowdbot.core.realism.bins import EDGES

    histogram = reference.whole.histograms["uni", "1.4"]["acceleration"]
    half = np.searchsorted(np.cumsum(histogram), 0.5 * histogram.sum())
    return float(EDGES["acceleration"][half])


def _table(head: list[str], rows: list[list[str]]) -> list[str]:
    return [f"| {' | '.join(line)} |" for line in [head, ["---"] * len(head), *rows]]


def write(rows: Mapping[str, tuple[str, dict[str, Any]]], reference: RealismReference) -> None:
    """Numbers and page, after each crowd: if this is stopped, what was measured is kept."""
    kept = dict(rows.values())
    atomic_write(NUMBERS, json.dumps(kept, indent=1, ensure_ascii=False) + "\n")
    atomic_write(PAGE, page([row for _, row in rows.values()], reference))


def main(arguments: Sequence[str]) -> None:
    """Measure and write."""
    from crowdbot.cli.shared.campaign_run import read_seeds

    words = list(arguments)
    seeds: Sequence[int] = SEEDS
    if "--seeds" in words:
        place = words.index("--seeds")
        seeds = tuple(read_seeds(words[place + 1]))
        del words[place : place + 2]
    registry, reference = discover(allow=()), shipped()
    before = json.loads(NUMBERS.read_text(encoding="utf-8")) if NUMBERS.exists() else {}
    rows = {row["name"]: (key, row) for key, row in before.items()}
    listed = dict(crowds(registry))
    for name in words:
        if name not in listed:
            raise UnknownNameError("crowd", name, sorted(listed))
    for name in words or listed:
        crowd = listed[name]
        found = measure(name, model_of(crowd, registry), reference, seeds)
        rows[name] = fingerprint(crowd), row_of(name, found)
        print(f"{found.line}, index {found.index:.3f}", flush=True)
        write({n: rows[n] for n in listed if n in rows}, reference)
    print(f"{PAGE}\n{NUMBERS}; floors: {', '.join(FLOORS)}")


if __name__ == "__main__":
    main(sys.argv[1:])
