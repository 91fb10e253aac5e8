"""The report as Markdown: headline scores of all runs, and significant differences."""

from __future__ import annotations

import math
from collections.abc import Sequence

from crowdbot.core.report.contents import Contents
from crowdbot.core.report.methods import methods
from crowdbot.core.scoring.four_scores import FOUR_SCORES, is_main
from crowdbot.core.statistics.comparison import Comparison
from crowdbot.core.statistics.crowds import CrowdRanks
from crowdbot.core.statistics.estimate_text import joined_text, range_text
from crowdbot.core.statistics.ladder import Ladder
from crowdbot.core.statistics.rules import Orders
from crowdbot.core.statistics.summary import PlannerScore, Summary
from crowdbot.core.support.text import plural


def markdown(contents: Contents) -> str:
    """Return the headline scores of all runs, and the significant differences, as Markdown."""
    summary, heading = contents.figures.headline, contents.heading
    lines = [f"# {_plain(heading.suite)}", ""]
    lines += [f"Made {_plain(heading.made)}.", ""] if heading.made else []
    lines += [text for line in contents.crowds for text in (f"Crowd: {_plain(line)}.", "")]
    lines += [
        text for x in contents.responses for text in (f"Response to the robot: {_plain(x)}.", "")
    ]
    lines += [f"**{_plain(contents.suspicion)}.**", ""] if contents.suspicion else []
    if contents.sample and contents.sample.too_small:
        lines += [f"**{_plain(contents.sample.text)}.**", ""]
    for check in contents.floors:
        mark = "**" if check.leads and not check.beats_all else ""
        lines += [f"{mark}{_plain(check.text)}.{mark}", ""]
    for text in heading.accepted:
        lines += [f"**Accepted: {_plain(text)}**", ""]
    for text in heading.warnings:
        lines += [f"Warning: {_plain(text)}", ""]
    lines += [*_table(*_endings(contents)), "", "## Scores", "", _meaning(summary), ""]
    lines += [*_table(*_scores(contents)), ""]
    if contents.pareto:
        lines += ["## Safe efficiency and acceptance", "", *_table(*_pareto(contents)), ""]
    for ladder in contents.ladders:
        lines += [f"## {_plain(ladder.kind)} on the ladder of sensing", ""]
        lines += [*_table(*_rungs(ladder)), ""]
    lines += _ordered(contents.orders) if contents.orders else []
    lines += _by_crowd(contents.ranks) if contents.ranks else []
    if any(not v.reason for v in summary.variances):
        lines += ["## What varies with which", "", *_table(*_variances(summary)), ""]
    if summary.comparisons:
        lines += ["## Planner against planner", "", _family(summary), ""]
        lines += [*_table(*_comparisons(summary)), ""]
    lines += ["## Methods", "", _plain(methods(contents)), ""]
    return "\n".join(lines)


def _pareto(contents: Contents) -> tuple[Sequence[str], list[Sequence[str]]]:
    """Return planners by both scores, and which are dominated."""
    rows: list[Sequence[str]] = [
        (_plain(p.planner), joined_text(p.efficiency), joined_text(p.acceptance), _plain(p.text))
        for p in contents.pareto
    ]
    return ("planner", "safe efficiency", "acceptance", "Pareto"), rows


def _rungs(ladder: Ladder) -> tuple[Sequence[str], list[Sequence[str]]]:
    """Return a table of a ladder's rungs, with each one's gain over the rung below."""
    rows: list[Sequence[str]] = [
        (
            _plain(rung.name),
            str(rung.runs),
            joined_text(rung.score),
            joined_text(rung.gain.by) if rung.gain else "",
        )
        for rung in ladder.rungs
    ]
    return ("people / place", "runs", ladder.metric.replace("_", " "), "gain"), rows


def _ordered(orders: Orders) -> list[str]:
    """Return ranks by the ranking rule and by others, and the verdict."""
    rows = [
        (_plain(p), *(f"{o.ranks[p]}{'=' * o.shares_rank(p)}" for o in orders.orders))
        for p in orders.planners
    ]
    lines = ["## Ranks", "", f"Ranks: {_plain(orders.verdict)}.", ""]
    if orders.missing:
        return lines
    table = _table(("planner", *(order.name for order in orders.orders)), rows)
    return [*lines, *table, "", *(f"- {o.name}: {o.text}" for o in orders.orders), ""]


def _by_crowd(ranks: CrowdRanks) -> list[str]:
    """Return the order per crowd, its agreement, and how often each planner is first."""
    orders = [
        (
            _plain(o.crowd),
            "not measured" if o.realism is None else f"{o.realism:.2f}",
            ", ".join(f"{_plain(p)} {joined_text(v)}" for p, v in o.means.items()),
            str(o.pairs),
        )
        for o in ranks.orders
    ]
    taus = [(_plain(a), _plain(b), alike(tau)) for (a, b), tau in ranks.taus.items()]
    return [
        "## Crowd by crowd", "", f"By {_plain(ranks.metric)}, the best first.", "",
        *_table(("crowd", "realism, 0 to 1 as recorded people", "order", "pairs"), orders), "",
        *_table(("crowd", "crowd", "Kendall's tau"), taus), "",
        *(f"- {_plain(v.text)}" for v in ranks.verdicts), "",
    ]  # fmt: skip


def alike(tau: float) -> str:
    """Return Kendall's tau as text."""
    return "– (an order without differences)" if math.isnan(tau) else f"{tau:+.2f}"


def _meaning(summary: Summary) -> str:
    return (
        "Mean over all runs with a value (of yes or no the share, of rates that of all runs "
        f"together), and its {100 * summary.level:g} % interval by Student's t over crowd draws, "
        f"within the bounds of the score. {chance(summary)} Runs without a value are counted, "
        "not dropped."
    )


def chance(summary: Summary) -> str:
    """Return the sources of variation that the intervals treat as random, in words."""
    if summary.conditions_fixed:
        return "Intervals show the variation between people; conditions are those of the suite."
    return (
        "Intervals include variation between people and conditions: with one crowd draw per "
        "condition they cannot be separated."
    )


def _variances(summary: Summary) -> tuple[Sequence[str], list[Sequence[str]]]:
    """Return variance shares of the main scores; of all scores if there are none."""
    known = [v for v in summary.variances if not v.reason]
    main = [v for v in known if is_main(v.metric, v.variant)] or known
    rows: list[Sequence[str]] = [
        (v.metric, _plain(v.planner), *(f"{100.0 * share:.0f} %" for share in v.shares[:2]),
         "" if v.seed is None else f"{100.0 * v.shares[2]:.0f} %")
        for v in main
    ]  # fmt: skip
    return ("metric", "planner", "condition", "crowd draw", "seed"), rows


def _family(summary: Summary) -> str:
    return (
        f"Pairs of the same scenario and seed. {summary.tests} tests of {family(summary)} share "
        f"the chance {summary.alpha:g} of any false verdict (Holm); all other scores are detail, "
        f"and share it among themselves. {_left_out(summary)}"
    ).rstrip()


def _left_out(summary: Summary) -> str:
    """Return how many comparisons are in the page only."""
    count = len(summary.comparisons) - len(_shown(summary))
    line = f"{plural(count, 'comparison')} of detail without a difference: on the page."
    return line if count else ""


def family(summary: Summary) -> str:
    """Return the name of the scores that share the probability of a false verdict."""
    main = any(is_main(s.metric, s.variant) for s in summary.scores)
    return FOUR_SCORES if main else "the headline scores"


def _endings(contents: Contents) -> tuple[Sequence[str], list[Sequence[str]]]:
    counts = {p: contents.counts(contents.of(p)) for p in contents.planners}
    head = ("planner", *(next(iter(counts.values()))))
    return head, [(_plain(p), *map(str, found.values())) for p, found in counts.items()]


def _scores(contents: Contents) -> tuple[Sequence[str], list[Sequence[str]]]:
    summary = contents.figures.headline
    places = {s.name: i for i, s in enumerate(contents.series)}
    shown = dict.fromkeys((s.metric, s.variant) for s in summary.scores)
    names = sorted(shown, key=lambda name: places.get(name, len(places)))
    scores = {(s.metric, s.variant, s.planner): s for s in summary.scores}
    rows: list[Sequence[str]] = []
    for metric, variant in names:
        here = [scores[metric, variant, planner] for planner in summary.planners]
        unit = "" if here[0].unit == "1" else here[0].unit
        cells = [_score_cell(s) for s in here]
        head = map(_plain, (f"{metric} {variant}".removesuffix(" corrected"), here[0].symbol, unit))
        rows.append((*head, here[0].better, *cells))
    return ("score", "symbol", "unit", "better", *map(_plain, summary.planners)), rows


def _score_cell(score: PlannerScore) -> str:
    counts = score.counts
    missing = [
        f"{count} {name}"
        for name, count in (
            ("censored", counts.censored),
            ("undefined", counts.undefined - score.reasons.get("not_scored", 0)),
            ("not kept", score.reasons.get("not_scored", 0)),
            ("failed", counts.failed),
        )
        if count
    ]
    return "; ".join([joined_text(score.mean), *missing, *_whole(score)])


def _whole(score: PlannerScore) -> list[str]:
    """Return bounds for the mean of all runs, if the mean of some is not enough."""
    if not score.counts.censored or all(end is None for end in score.bounds):
        return []
    return [f"mean of all {range_text(score.bounds)}"]


def _comparisons(summary: Summary) -> tuple[Sequence[str], list[Sequence[str]]]:
    head = ("score", "a", "b", "a − b", "probability that a is better", "p (Holm)", "verdict")
    return head, [_comparison(c) for c in _shown(summary)]


def _shown(summary: Summary) -> list[Comparison]:
    """Return comparisons of the deciding scores, and of others those with a difference."""
    found = summary.comparisons
    if not any(is_main(c.metric, c.variant) for c in found):
        return list(found)
    differs = ("better", "worse")
    return [c for c in found if is_main(c.metric, c.variant) or c.verdict in differs]


def _comparison(comparison: Comparison) -> Sequence[str]:
    verdict = (
        f"a is {comparison.verdict}"
        if comparison.verdict in ("better", "worse")
        else comparison.verdict
    )
    score = f"{comparison.metric} {comparison.variant}".removesuffix(" corrected")
    p_holm = "–" if comparison.p_holm is None else f"{comparison.p_holm:.3g}"
    estimates = (joined_text(comparison.difference), joined_text(comparison.improvement))
    return (*map(_plain, (score, comparison.a, comparison.b)), *estimates, p_holm, verdict)


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    lines = [head, ["---"] * len(head), *rows]
    return [f"| {' | '.join(line)} |" for line in lines]


def _plain(text: str) -> str:
    """Escape text for Markdown, since names are user input."""
    escaped = "".join(f"\\{c}" if c in "\\|*`<>[]#&" else c for c in text)
    return " ".join(escaped.split())
