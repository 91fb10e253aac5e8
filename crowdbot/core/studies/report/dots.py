"""A drawing of one score: a dot for each participant in each condition, and means."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from crowdbot.core.studies.findings import StudyFinding

_WIDTH, _HEIGHT, _LEFT, _TOP, _BOTTOM = 640.0, 260.0, 70.0, 16.0, 34.0


def dots(findings: Sequence[StudyFinding], titles: Sequence[str], label: str) -> str:
    """Return the SVG element; values of one participant are joined by lines.

    Args:
        findings: of one score, by condition; at least one has a value.
        titles: of the conditions.
        label: text alternative for screen readers.
    """
    numbers = [v for f in findings for v in f.values.values()]
    numbers += [x for f in findings for x in (f.mean.low, f.mean.high) if x is not None]
    low, high = min(numbers), max(numbers)
    spread = (high - low) or max(abs(high), 1.0)
    low, high = low - 0.06 * spread, high + 0.06 * spread
    step = (_WIDTH - _LEFT - 20.0) / len(findings)
    x = [_LEFT + (k + 0.5) * step for k in range(len(findings))]

    def y(value: float) -> float:
        return _TOP + (high - value) / (high - low) * (_HEIGHT - _TOP - _BOTTOM)

    parts = [_axis(y, low, high)]
    for person in sorted({p for f in findings for p in f.values}):
        at = [(x[k], y(f.values[person])) for k, f in enumerate(findings) if person in f.values]
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in at)
        parts.append(f'<polyline class="one" points="{points}"/>')
        parts += [f'<circle class="one" cx="{a:.1f}" cy="{b:.1f}" r="4"/>' for a, b in at]
    for k, (f, title) in enumerate(zip(findings, titles, strict=True)):
        parts.append(_mean(f, x[k] + 18.0, y))
        place = f'x="{x[k]:.1f}" y="{_HEIGHT - 10:.1f}" text-anchor="middle"'
        parts.append(f"<text {place}>{escape(title)}</text>")
    inner = "".join(parts)
    return (
        f'<svg viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}" role="img" aria-label="{escape(label)}">'
        f"{inner}</svg>"
    )


def _axis(y: object, low: float, high: float) -> str:
    assert callable(y)
    ticks = [low + share * (high - low) for share in (0.1, 0.5, 0.9)]
    return "".join(
        f'<line class="grid" x1="{_LEFT:g}" x2="{_WIDTH - 20:g}" y1="{y(v):.1f}" y2="{y(v):.1f}"/>'
        f'<text x="{_LEFT - 8:g}" y="{y(v) + 4:.1f}" text-anchor="end">{v:.3g}</text>'
        for v in ticks
    )


def _mean(finding: StudyFinding, x: float, y: object) -> str:
    """Return the mean with its interval, beside the dots."""
    assert callable(y)
    found = finding.mean
    if found.value is None:
        return ""
    corner = f'x="{x - 5:.1f}" y="{y(found.value) - 5:.1f}"'
    mark = f'<rect class="mean" {corner} width="10" height="10"/>'
    if found.low is None or found.high is None:
        return mark
    line = f'<line class="mean" x1="{x:.1f}" x2="{x:.1f}" y1="{y(found.low):.1f}" '
    return f'{line}y2="{y(found.high):.1f}"/>{mark}'
