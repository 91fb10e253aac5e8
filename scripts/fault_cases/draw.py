"""Pictures of the cases, and the page with the decision table."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from scripts.fault_cases.cases import CASES, LONG, PERSON, ROBOT, Case, T, Track

ROOT = Path(__file__).resolve().parents[2]
_PIXELS = 70.0  # per metre
_MARGIN = 0.45  # m
_ROBOT, _PERSON, _PATH = "#2b6cb0", "#c05621", "#8a8a8a"

RULES = {
    "driven": (
        "the touching point moved towards the person by more than `fault_speed`, and the robot "
        "had not braked since the contact was foreseeable",
        True,
    ),
    "came_over": (
        "the robot came over by a turn or a start: with its velocity of twice `fault_reaction` "
        "before, it would have passed by more than `fault_margin`, and the person did not change "
        "theirs",
        True,
    ),
    "pushed": (
        "while the contact lasts, after `fault_reaction`, the touching point comes nearer faster "
        "than braking allows, or moves the person by more than `fault_margin`; a contact that "
        "exists from the start allows no speed",
        True,
    ),
    "cut_in": (
        "the robot moved from beside the straight way of a faster person onto it, later than "
        "`fault_reaction` + difference of speeds / `fault_braking` before the contact",
        True,
    ),
    "braked": (
        "the robot braked as soon as the contact was foreseeable, or it was foreseeable only "
        "within `fault_reaction`",
        False,
    ),
    "shoved": (
        "another person touches the robot from the other side meanwhile; before a contact this "
        "excuses only a robot that stood until then",
        False,
    ),
    "stands": ("none of these", False),
}

_HEAD = """# Whose fault a contact is

A contact with a person is the robot's fault if one of the first four lines holds. The numbers \
are parameters of [contacts_at_fault](metrics/contacts_at_fault.md); `contacts_per_km` and \
`safe_efficiency` use the same rule. The touching point is the point of the robot's outline that \
is nearest to the person: if a long robot turns on the spot, its end moves although its \
centre stands.

"""

_MIDDLE = """
The margins are a person's: 0.3 s to react, and braking by 1 m/s², which robots of these suites \
can do. A person behind is expected to keep a distance that is enough to stop; so a robot \
may slow down or stop on its way at any time, but not move onto the way of a person who can no \
longer stop. A robot that stands is never at fault, unless it stands where it has just cut in.

## Cases

Each picture shows a robot (blue) and people (orange) at three times, from light to dark. \
`tests/core/trajectories/fault/test_decision_table.py` checks each of them.

"""

_LIMITS = """
## What the rule does not see

People may judge these four otherwise; a robot gains nothing from them in `challenge-2026` \
([measured](../decisions/0036-fault-and-the-ranking-rule.md#what-adversaries-gain)).

- **Tailgating.** The robot follows at 0.2 m, the person stops at once, and the robot brakes \
after its reaction time: no fault, since nothing was foreseeable before.
- **Cutting in, then braking.** The robot moves in front of a person with a gap of 0.05 m, and \
stops a second later: no fault, since the person had the time to react to the cutting in, though \
not the room.
- **Passing at 5 cm at full speed.** The person sways by 8 cm into the robot's flank: no fault, \
since the touching point hardly comes nearer. [Acceptance](metrics/acceptance.md) counts it.
- **Hidden people.** Cutting in is judged by where people walk, even if a wall hides them. A robot \
that drives straight on, and stands as soon as a person has stepped out of a door across its way, \
has cut in.
"""


def files() -> dict[Path, str]:
    """Return file -> text of the page and of all pictures."""
    found = {ROOT / "docs" / "reference" / "fault.md": page()}
    images = ROOT / "docs" / "images" / "fault"
    return found | {images / f"{case.name}.svg": picture(case) for case in CASES}


def page() -> str:
    """Return the text of docs/reference/fault.md."""
    lines = ["| | rule | fault |", "|---|---|---|"]
    for name, (expected, fault) in RULES.items():
        lines.append(f"| {name.replace('_', ' ')} | {expected} | {_yes(fault)} |")
    cases = ["| the robot … | | fault | rule |", "|---|---|---|---|"]
    for case in CASES:
        picture = f"![{case.told}](../images/fault/{case.name}.svg)"
        rule = case.rule.replace("_", " ")
        cases.append(f"| {case.told} | {picture} | {_yes(case.fault)} | {rule} |")
    return _HEAD + "\n".join(lines) + "\n" + _MIDDLE + "\n".join(cases) + "\n" + _LIMITS


def _yes(fault: bool) -> str:
    return "**yes**" if fault else "no"


def picture(case: Case) -> str:
    """Return a case as SVG."""
    tracks = (case.robot, *case.people)
    shown = [int(np.argmin(np.abs(T - time))) for time in case.shown]
    xs = np.concatenate([track.x[shown] for track in tracks])
    ys = np.concatenate([track.y[shown] for track in tracks])
    size = 0.7 if case.outline else ROBOT
    west, east = np.nanmin(xs) - size - _MARGIN, np.nanmax(xs) + size + _MARGIN
    south, north = np.nanmin(ys) - size - 0.1, np.nanmax(ys) + size + 0.1
    width, height = (east - west) * _PIXELS, (north - south) * _PIXELS
    body = "\n".join(_shapes(case, shown))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" width="{width:.0f}" '
        f'height="{height:.0f}" viewBox="{west:.3f} {-north:.3f} {east - west:.3f} '
        f'{north - south:.3f}">\n<title>The robot {case.told}</title>\n{body}\n</svg>\n'
    )


def _shapes(case: Case, shown: list[int]) -> Iterator[str]:
    for track, colour in ((case.robot, _ROBOT), *((p, _PERSON) for p in case.people)):
        yield _path(track, shown)
        for place, k in enumerate(shown):
            if not math.isfinite(track.x[k]):
                continue
            opacity = (0.25, 0.5, 1.0)[place]
            style = f'fill="{colour}" fill-opacity="{opacity * 0.7:.3g}" stroke="{colour}"'
            style += ' stroke-width="0.015"'
            if colour == _ROBOT and case.outline:
                yield _outline(track, k, style)
            else:
                radius = ROBOT if colour == _ROBOT else PERSON
                yield f'<circle cx="{track.x[k]:.3f}" cy="{-track.y[k]:.3f}" r="{radius}" {style}/>'


def _path(track: Track, shown: list[int]) -> str:
    here = [i for i in range(shown[0], shown[-1] + 1, 4) if math.isfinite(track.x[i])]
    points = " ".join(f"{track.x[i]:.3f},{-track.y[i]:.3f}" for i in here)
    return f'<polyline points="{points}" fill="none" stroke="{_PATH}" stroke-width="0.02"/>'


def _outline(track: Track, k: int, style: str) -> str:
    c, s = math.cos(track.theta[k]), math.sin(track.theta[k])
    turned = LONG @ np.array([[c, s], [-s, c]]) + np.array([track.x[k], track.y[k]])
    points = " ".join(f"{x:.3f},{-y:.3f}" for x, y in turned)
    return f'<polygon points="{points}" {style}/>'
