"""The table of planners by what they need and how they did, from the shipped reference scores."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import fmean

from crowdbot.core.planning.description import role_of
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.results.reference_file import ReferenceScores, open_references
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow

PAGE = Path(__file__).parent.parent / "docs" / "reference" / "planners.md"
BEGIN = "<!-- Table written by make generate: change the reference scores, not this. -->\n"
END = "<!-- end of the table -->"
_SCORES = (
    ("safe efficiency", "safe_efficiency", "corrected"),
    ("acceptance", "acceptance", "corrected"),
    ("contacts at fault, a run", "contacts_at_fault", "corrected"),
)


def page() -> str:
    """Return the page of planners with the table as it is now."""
    found = open_references("crowdbot")
    assert found is not None
    text = PAGE.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    after = rest.partition(END)[2]
    table = "\n".join(_tables(found))
    return f"{before}{BEGIN}\n{table}\n{END}{after}"


def _tables(found: ReferenceScores) -> Iterator[str]:
    registry = discover()
    suites = dict.fromkeys(run.suite for run in found.results.runs)
    for suite, held in zip(suites, found.held, strict=True):
        runs = [run for run in found.results.runs if run.suite == suite]
        values = held.partition(";")[0].partition(": ")[2]
        yield f"`{suite}`: {values}.\n"
        names = ("arrived", *(name for name, *_ in _SCORES))
        yield f"| planner | role | needs | {' | '.join(names)} |"
        yield "|---" * (3 + len(names)) + "|"
        yield from _rows(runs, found.results, registry)
        yield ""


def _rows(runs: Sequence[RunRow], results: Results, registry: Registry) -> Iterator[str]:
    values: dict[tuple[str, str, str], float] = {
        (s.run_id, s.metric, s.variant): s.value for s in results.scores if s.value is not None
    }
    lines = []
    for planner in dict.fromkeys(run.planner for run in runs):
        own = [run for run in runs if run.planner == planner]
        kind = own[0].record.planner.kind
        spec = registry.components("planner")[kind].spec
        needs = "the truth" if own[0].privileged else ", ".join(getattr(spec, "needs", None) or ())
        arrived = fmean(run.status == "arrived" for run in own)
        means = []
        for _, metric, variant in _SCORES:
            known = [values[key] for run in own if (key := (run.run_id, metric, variant)) in values]
            means.append(fmean(known) if known else 0.0)
        cells = [f"{100.0 * arrived:.0f} %", *(f"{m:.2f}" for m in means)]
        row = f"| `{kind}` | {role_of(spec)} | {needs or 'nothing'} | {' | '.join(cells)} |"
        lines.append((-means[0], row))
    yield from (row for _, row in sorted(lines))
