"""The methods of a report as a paragraph for a paper."""

from __future__ import annotations

from collections.abc import Sequence

from crowdbot.core.report.contents import Contents
from crowdbot.core.scoring.four_scores import is_main
from crowdbot.core.support.text import plural
from crowdbot.core.types.ending import Ending, shown

_SOFTWARE = ("crowdbot", "drake", "numpy", "python")


def methods(contents: Contents) -> str:
    """Describe runs, summaries, comparisons and software versions.

    All numbers are those of the report; results are not mentioned.
    """
    parts = [_ran(contents), _ended(contents), _summed_up(contents), *_compared(contents)]
    parts += [f"We accepted that the runs differ in this: {text}." for text in _accepted(contents)]
    return " ".join([*parts, _software(contents)])


def _ran(contents: Contents) -> str:
    runs = contents.results.runs
    planners = _and([_named(contents, p) for p in contents.planners])
    scenarios = len({a.scenario for a in contents.attempts})
    draws = len({run.realisation_hash for run in runs})
    return (
        f"We simulated {planners} in {plural(scenarios, 'scenario')} of the suite "
        f"{contents.heading.suite}, with {plural(draws, 'independent crowd draw')} and the "
        f"{_seeds(contents.seeds)}: {plural(len(contents.attempts), 'run')} in all."
    )


def _named(contents: Contents, planner: str) -> str:
    """Return a planner's name with the facts that readers need."""
    marks = [
        contents.role(planner) if contents.role(planner) != "candidate" else "",
        "driven by a person" if contents.is_person(planner) else "",
        "privileged" if contents.is_privileged(planner) else "",
        "reference scores" if planner in contents.heading.references else "",
    ]
    notes = ", ".join(filter(None, marks))
    return f"{planner} ({notes})" if notes else planner


def _seeds(seeds: Sequence[int]) -> str:
    if len(seeds) > 2 and seeds == list(range(seeds[0], seeds[-1] + 1)):
        return f"seeds {seeds[0]} to {seeds[-1]}"
    return f"seed{'s' if len(seeds) > 1 else ''} {_and(list(map(str, seeds)))}"


def _ended(contents: Contents) -> str:
    counts = contents.counts()
    others = [ending for ending in shown(counts) if ending != Ending.ARRIVED]
    rest = [f"{counts[ending]} {ending.past}" for ending in others if counts[ending]]
    return f"The robot arrived in {counts[Ending.ARRIVED]} of them" + (
        f"; {_and(rest)}." if rest else "."
    )


def _summed_up(contents: Contents) -> str:
    summary = contents.figures.headline
    return (
        "We report the mean of each score over the runs in which it is defined, the share of "
        "yes-or-no scores, and rates as the sum of what was counted over the sum of what it is a "
        f"rate over, with {100 * summary.level:g} % confidence intervals by Student's t over "
        "whole crowd draws, because runs in one crowd are not independent; intervals of bounded "
        "scores are score intervals (Wilson), which do not leave the bounds."
    )


def _compared(contents: Contents) -> list[str]:
    summary = contents.figures.headline
    if not summary.comparisons:
        return []
    main = any(is_main(s.metric, s.variant) for s in summary.scores)
    family = "the four scores" if main else "the scores"
    sentences = [
        "Means were compared in pairs of the same scenario and seed by sign-flip tests, which "
        "exchange the signs of whole crowd draws; Holm's correction over the "
        f"{plural(summary.tests, 'test')} of {family} keeps the chance of any false verdict "
        f"among them at {100 * summary.alpha:g} %. A run in which the planner failed counts as "
        "worse than any other."
    ]
    sample = contents.sample
    if sample is not None and sample.too_small:
        sentences.append(
            f"With {plural(sample.draws, 'crowd draw')} no verdict was possible; at least "
            f"{sample.least} would be needed."
        )
    return sentences


def _accepted(contents: Contents) -> list[str]:
    return [text.rstrip(".") for text in contents.heading.accepted]


def _software(contents: Contents) -> str:
    versions = contents.facts.get("software", {})
    named = [f"{name} {versions[name]}" for name in _SOFTWARE if name in versions]
    digest = contents.hashes["sha256 of all run ids and trajectory hashes"]
    with_ = f"Simulated with {_and(named)}. " if named else ""
    return f"{with_}The data are identified by sha256 {digest[:16]}."


def _and(parts: Sequence[str]) -> str:
    if len(parts) < 2:
        return "".join(parts)
    return f"{', '.join(parts[:-1])} and {parts[-1]}"
