"""The report for a paper: LaTeX tables in the style of booktabs, and a figure as PDF and SVG.

Captions state what each number rests on: runs, crowd draws, and the kind of interval.
"""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crowdbot.core.report.contents import Contents
from crowdbot.core.report.lead import LeadColumn, main_columns
from crowdbot.core.report.methods import methods
from crowdbot.core.scoring.four_scores import PRIMARY
from crowdbot.core.statistics.comparison import Comparison
from crowdbot.core.statistics.estimate_text import estimate_text
from crowdbot.core.statistics.summary import Summary
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.text import plural

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Characters that LaTeX reads as commands -> what prints them.
_SPECIAL = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#",
    "%": r"\%", "_": r"\_", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
    "−": "$-$", "–": "--", "²": r"\textsuperscript{2}", "³": r"\textsuperscript{3}",
    "·": r"\(\cdot\)", "°": r"\textdegree{}", "↑": r"\(\uparrow\)", "↓": r"\(\downarrow\)",
    "<": r"\textless{}", ">": r"\textgreater{}",
}  # fmt: skip
#: Opens a box that shrinks a table to the width of the text, if it is wider.
_AS_WIDE_AS_FITS = r"\resizebox{\ifdim\width>\linewidth\linewidth\else\width\fi}{!}{%"
#: Settings of Matplotlib: the size of body text in two columns, and letters that stay letters.
STYLE: Any = {
    "font.size": 8.0, "font.family": "serif", "axes.linewidth": 0.6, "lines.linewidth": 0.9,
    "xtick.major.width": 0.6, "ytick.major.width": 0.6, "axes.spines.top": False,
    "axes.spines.right": False, "pdf.fonttype": 42, "svg.fonttype": "path",
    "svg.hashsalt": "crowdbot", "text.parse_math": False,
}  # fmt: skip
#: Width of a page's text, and height without planners and of each, inches.
_WIDTH, _MARGIN, _ROW = 7.0, 0.75, 0.24
#: Most rows of a table that fit on a page.
_ROWS = 48
#: Metadata without times, so that equal results give equal bytes.
_META: dict[str, dict[str, Any]] = {
    "pdf": {"CreationDate": None, "Producer": "crowdbot"},
    "svg": {"Date": None, "Creator": "crowdbot"},
}


def write_paper(path: Path, contents: Contents) -> dict[str, Path]:
    """Write tables and the figure beside a report.

    Args:
        path: of the report's page; these files have other suffixes.
        contents: contents of the report.

    Returns:
        ``tex``, ``pdf`` and ``svg``: paths of the files.

    Raises:
        InputError: they cannot be written there.
    """
    paths = {kind: path.with_suffix(f".{kind}") for kind in ("tex", "pdf", "svg")}
    atomic_write(paths["tex"], tex(contents, paths["pdf"].name))
    for kind, picture in pictures(contents).items():
        atomic_write(paths[kind], picture)
    return paths


def tex(contents: Contents, figure: str) -> str:
    """Return tables of main scores and comparisons, the figure's caption, and the methods.

    Args:
        contents: contents of the report.
        figure: name of the figure's file.
    """
    summary = contents.figures.headline
    columns = main_columns(summary)
    parts = [
        "% Needs \\usepackage{booktabs} and \\usepackage{graphicx}; \\input this file.",
        _scores(contents, columns),
        _comparisons(contents, columns),
        _figure(contents, figure),
        f"% Methods:\n{escaped(methods(contents))}",
    ]
    return "\n\n".join(filter(None, parts)) + "\n"


def escaped(text: str) -> str:
    """Return a text that LaTeX prints as it is."""
    return "".join(_SPECIAL.get(c, c) for c in text)


def caption(contents: Contents, subject: str) -> str:
    """Return a caption: the subject, then runs, crowd draws and intervals."""
    summary = contents.figures.headline
    draws = {s.draws for c in main_columns(summary) for s in c.scores if s.counts.ok}
    low, high = min(draws, default=0), max(draws, default=0)
    crowds = plural(low, "crowd draw") if low == high else f"{low} to {plural(high, 'crowd draw')}"
    runs = ", ".join(f"{p} {len(contents.of(p))}" for p in contents.planners)
    scenarios = plural(len({a.scenario for a in contents.attempts}), "scenario")
    return (
        f"{subject} in {scenarios} of {contents.heading.suite}. Runs: {runs}. Brackets and bars: "
        f"{100 * summary.level:g} % intervals by Student's t over {crowds}."
    )


# --------------------------------------------------------------------------- tables
def _scores(contents: Contents, columns: Sequence[LeadColumn]) -> str:
    head = ["planner", "runs", *(_named(c) for c in columns)]
    rows = [
        [planner, str(len(contents.of(planner))),
         *(" ".join(estimate_text(c.scores[i].mean)) + _missing(c, i) for c in columns)]
        for i, planner in enumerate(contents.planners)
    ]  # fmt: skip
    caption_text = caption(contents, "Mean scores")
    if any(_missing(c, i) for c in columns for i in range(len(contents.planners))):
        caption_text += " In parentheses: the runs with a value, where some have none."
    return _table(caption_text, "scores", "lr" + "r" * len(columns), head, rows)


def _missing(column: LeadColumn, place: int) -> str:
    counts = column.scores[place].counts
    lost = counts.censored + counts.undefined + counts.failed
    return f" (n = {counts.ok})" if lost else ""


def _named(column: LeadColumn) -> str:
    arrow = {"higher": " ↑", "lower": " ↓"}.get(column.scores[0].better, "")
    unit = column.scores[0].unit
    return f"{column.role}{arrow}{'' if unit == '1' else f', {unit}'}"


def _comparisons(contents: Contents, columns: Sequence[LeadColumn]) -> str:
    summary, known = contents.figures.headline, set(contents.heading.references)
    roles = {(c.scores[0].metric, c.scores[0].variant): c.role for c in columns}
    found = [c for c in summary.comparisons if (c.metric, c.variant) in roles]
    shown = [c for c in found if not {c.a, c.b} <= known] or found
    caption = _compared(summary)
    if len(shown) > _ROWS:
        shown = [c for c in shown if roles[c.metric, c.variant] == PRIMARY.role] or shown
        caption += f" Only {PRIMARY.role} is shown."
    rows = [
        [roles[c.metric, c.variant], c.a, c.b, " ".join(estimate_text(c.difference)),
         _p(c), str(c.pairs), str(c.draws), c.verdict]
        for c in shown
    ]  # fmt: skip
    if not rows:
        return ""
    head = ["score", "a", "b", "a − b", "p (Holm)", "pairs", "draws", "a is"]
    return _table(caption, "comparisons", "lllrrrrl", head, rows)


def _compared(summary: Summary) -> str:
    return (
        "Paired differences of the same scenario and seed, with "
        f"{100 * summary.level:g} % intervals over crowd draws. p: sign-flip tests over crowd "
        f"draws, corrected for {plural(summary.tests, 'test')} (Holm); a verdict needs at most "
        f"{summary.alpha:g}."
    )


def _p(comparison: Comparison) -> str:
    return "–" if comparison.p_holm is None else f"{comparison.p_holm:.3g}"


def _table(
    caption_text: str, label: str, columns: str, head: Sequence[str], rows: Sequence[Sequence[str]]
) -> str:
    lines = [f"{' & '.join(map(escaped, row))} \\tabularnewline" for row in (head, *rows)]
    return "\n".join([
        "\\begin{table}", "\\centering", f"\\caption{{{escaped(caption_text)}}}",
        f"\\label{{tab:{label}}}", "\\medskip", _AS_WIDE_AS_FITS,
        f"\\begin{{tabular}}{{{columns}}}", "\\toprule", lines[0],
        "\\midrule", *lines[1:], "\\bottomrule", "\\end{tabular}}", "\\end{table}",
    ])  # fmt: skip


# --------------------------------------------------------------------------- figure
def _figure(contents: Contents, name: str) -> str:
    return "\n".join([
        "\\begin{figure}", "\\centering", f"\\includegraphics[width=\\linewidth]{{{name}}}",
        f"\\caption{{{escaped(caption(contents, 'Main scores'))}}}", "\\label{fig:scores}",
        "\\end{figure}",
    ])  # fmt: skip


def pictures(contents: Contents) -> dict[str, bytes]:
    """Return ``pdf`` and ``svg`` of the main scores, a panel each, with their intervals."""
    import matplotlib as mpl

    with mpl.rc_context(STYLE):
        figure = _drawn(contents)
        found = {}
        for kind, meta in _META.items():
            file = BytesIO()
            figure.savefig(file, format=kind, metadata=meta)
            found[kind] = file.getvalue()
    return found


def _drawn(contents: Contents) -> Figure:
    from matplotlib.figure import Figure

    columns = main_columns(contents.figures.headline)
    height = _MARGIN + _ROW * len(contents.planners)
    figure = Figure(figsize=(_WIDTH, height), layout="constrained")
    panels = figure.subplots(1, max(1, len(columns)), sharey=True, squeeze=False)[0]
    for axes, column in zip(panels, columns, strict=False):
        _panel(axes, column)
    panels[0].set_yticks(range(len(contents.planners)), labels=contents.planners)
    panels[0].set_ylim(len(contents.planners) - 0.5, -0.5)
    return figure


def _panel(axes: Axes, column: LeadColumn) -> None:
    """Draw the means of one score, one row per planner."""
    for row, score in enumerate(column.scores):
        mean = score.mean
        if mean.value is None:
            continue
        if mean.low is not None and mean.high is not None:
            axes.plot([mean.low, mean.high], [row, row], color="0.45", solid_capstyle="butt")
        axes.plot([mean.value], [row], "o", color="black", markersize=3.5)
    unit = column.scores[0].unit
    axes.set_xlabel(f"{column.role}{'' if unit == '1' else f' ({unit})'}")
    axes.grid(axis="x", color="0.9", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.tick_params(axis="y", length=0)
