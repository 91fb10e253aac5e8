"""scores.csv, and the table of scores for terminals."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import groupby
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from crowdbot.core.scoring.four_scores import FOUR_SCORES, beside_main, main_first
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.text import wrap_name
from crowdbot.core.support.text_files import read_text
from crowdbot.core.types.score import Score
from crowdbot.errors import InputError, hidden_character

if TYPE_CHECKING:
    from rich.table import Table

COLUMNS = (
    "scenario",
    "planner",
    "seed",
    "category",
    "metric",
    "symbol",
    "variant",
    "value",
    "unit",
    "better",
    "status",
    "reason",
    "lower",
    "upper",
)
#: End of a line of CSV.
_END = "\r\n"
_VALUE_WIDTH, _WHOLE_NAMES = 20, 80
#: Largest length of names in narrow terminals.
_NAME_WIDTH = 14
_NUMBERS = ("value", "lower", "upper")
_TEXTS = ("category", "metric", "symbol", "variant", "unit", "better", "status", "reason")
#: Place of the value among the columns from ``category`` on.
_VALUE = COLUMNS.index("value") - COLUMNS.index("category")


@dataclass(frozen=True, slots=True, kw_only=True)
class RunScore:
    """One row of scores.csv, which does not contain extras."""

    scenario: str
    planner: str
    seed: int
    score: Score


# ------------------------------------------------------------------------ csv
def write_scores_csv(
    path: str | os.PathLike[str], scores: Iterable[Score], scenario: str, planner: str, seed: int
) -> None:
    """Write one row per score as CSV (RFC 4180, UTF-8) with exact floats.

    The file is written atomically.

    Raises:
        InputError: it cannot be written there.
    """
    rows = [(scenario, planner, str(seed), *cells_of(s)) for s in scores]
    write_table(Path(path), [COLUMNS, *rows])


def write_table(path: Path, rows: Iterable[Sequence[str]]) -> None:
    """Write rows of text as CSV (RFC 4180, UTF-8), atomically.

    Raises:
        InputError: it cannot be written there.
    """
    text, safe = io.StringIO(newline=""), _SafeCells()
    csv.writer(text).writerows([safe[cell] for cell in row] for row in rows)
    atomic_write(path, text.getvalue())


def csv_cells(cells: Sequence[str]) -> str:
    """Return cells as a part of a line of CSV, safe for spreadsheets."""
    return csv_lines([cells])[0]


def csv_lines(rows: Iterable[Sequence[str]]) -> list[str]:
    """Return rows of cells as lines of CSV without their ends, safe for spreadsheets."""
    lines, safe = list[str](), _SafeCells()
    writer = csv.writer(SimpleNamespace(write=lines.append))
    writer.writerows([safe[cell] for cell in row] for row in rows)
    return [line.removesuffix(_END) for line in lines]


def safe_cell(cell: str) -> str:
    """Return a cell that no spreadsheet treats as a formula.

    It gets an apostrophe in front if needed.
    """
    if not cell.startswith(("=", "+", "-", "@", "\t", "\r")):
        return cell
    try:
        float(cell)
    except ValueError:
        return f"'{cell}"
    return cell


class _SafeCells(dict[str, str]):
    """A cache of `safe_cell`, since most texts occur in every run."""

    def __missing__(self, cell: str) -> str:
        self[cell] = safe = safe_cell(cell)
        return safe


def read_scores_csv(path: str | os.PathLike[str]) -> list[RunScore]:
    """Read a file that `write_scores_csv` wrote.

    Raises:
        InputError: missing file, wrong columns, or an invalid score (the message names the line).
    """
    path = Path(path)
    try:
        text = read_text(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not a table of scores: {error}") from error
    return parse_scores(text, path)


def parse_scores(text: str, name: str | os.PathLike[str]) -> list[RunScore]:
    """Return the rows of a ``scores.csv``; ``name`` is used in messages.

    Raises:
        InputError: wrong columns, or an invalid score (the message names the line).
    """
    path = os.fspath(name)
    try:
        reader = csv.reader(io.StringIO(text, newline=""), strict=True)
        if tuple(next(reader, ())) != COLUMNS:
            raise InputError(f"{path}:1: not a table of scores: expected {','.join(COLUMNS)}")
        return [_row(path, reader.line_num, cells) for cells in reader if cells]
    except csv.Error as error:
        raise InputError(f"{path}: is not a table of scores: {error}") from error


def cells_of(score: Score) -> list[str]:
    """Return the cells of the columns from ``category`` on."""
    cells = {name: str(getattr(score, name)) for name in _TEXTS}
    for name in _NUMBERS:
        number = getattr(score, name)
        cells[name] = "" if number is None else repr(float(number))
    return [cells[name] for name in COLUMNS[3:]]


def _row(path: str, line: int, cells: Sequence[str]) -> RunScore:
    try:
        if len(cells) != len(COLUMNS):
            raise ValueError(f"a row must have {len(COLUMNS)} cells")
        scenario, planner, seed, *texts, reason, lower, upper = cells
        value = texts.pop(_VALUE)
        about = _texts((*texts, reason))
        score = Score(
            **about,
            value=float(_plain(value)) if value else None,
            lower=float(_plain(lower)) if lower else None,
            upper=float(_plain(upper)) if upper else None,
        )
        return RunScore(scenario=scenario, planner=planner, seed=_seed(seed), score=score)
    except ValueError as error:
        raise InputError(f"{path}:{line}: not a score: {error}") from error


def _plain(number: str) -> str:
    """Return a portable number text: Python also accepts ``1_0``, spaces and other digits."""
    if not number.isascii() or "_" in number or number != number.strip():
        raise ValueError(f"'{number[:40]}' is not a number")
    return number


@lru_cache(maxsize=256)
def _seed(cell: str) -> int:
    return int(_plain(cell))


@lru_cache(maxsize=4096)
def _texts(cells: tuple[str, ...]) -> Mapping[str, Any]:
    """Return the texts of a score by name; cached, since every run has the same few."""
    named = dict(zip(_TEXTS, cells, strict=True))
    for name, known in (
        ("status", ("ok", "undefined", "censored")),
        ("better", ("higher", "lower", "reference", "none")),
    ):
        if named[name] not in known:
            raise ValueError(f"{name} '{named[name]}' is not one of {', '.join(known)}")
    for name, text in named.items():
        if hidden := hidden_character(text):
            raise ValueError(f"{name} has the hidden character {hidden}")
    return named


# ------------------------------------------------------------------- terminal
#: Reasons of metrics whose data no simulated run has: commands and answers of a driver.
_NOT_ASKED = ("no_command", "no_baseline", "no_answers", "no_formula_in_seed")
_SIGNS = {"higher": "+", "lower": "-", "reference": "=", "none": ""}


def headlines(scores: Sequence[Score]) -> list[Score]:
    """Return one score per metric with data in the run; the four main scores first.

    This is the rate or the pace if the metric has one, else the corrected variant, else its
    headline.
    """
    found = []
    for _, group in groupby(scores, key=lambda s: s.metric):
        variants = [s for s in group if s.reason not in _NOT_ASKED]
        corrected = [s for s in variants if s.variant == "corrected"]
        restricted = [s for s in variants if s.variant == "restricted" and s.status == "ok"]
        unclear = corrected and corrected[0].status != "ok"
        rate = [s for s in variants if s.variant in ("rate", "pace")]
        found += (rate + (restricted if unclear else []) + corrected + variants)[:1]
    return main_first(found, _name)


def _name(score: Score) -> tuple[str, str]:
    return score.metric, score.variant


def section_of(score: Score) -> str:
    """Return the heading of a score: its category, except for the four main scores."""
    return FOUR_SCORES if beside_main(*_name(score)) else score.category


def scores_table(scores: Sequence[Score]) -> Table:
    """Return a readable table, the four main scores first, then by category.

    It fits the terminal: in one of less than 80 columns names are broken between their words, and
    none is left out. The last column shows the better direction: + higher, - lower, = like people.
    """
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=SIMPLE_HEAD, padding=0, pad_edge=False)
    whole = Console().width >= _WHOLE_NAMES
    for name in ("metric", "symbol", "variant"):
        table.add_column(name, overflow="fold", no_wrap=whole)
    table.add_column("value", overflow="fold", min_width=_VALUE_WIDTH if whole else None)
    table.add_column("", min_width=1, no_wrap=True)
    by_category = main_first(sorted(scores, key=lambda s: s.category), _name)
    for category, group in groupby(by_category, key=section_of):
        table.add_section()
        table.add_row(Text(category, style="bold"))
        shown = ""
        for s in group:
            head = ("", "") if s.metric == shown else (s.metric, s.symbol)
            style = "" if s.status == "ok" else "dim"
            names = [*head, s.variant]
            if not whole:
                names[0] = wrap_name(names[0], _NAME_WIDTH)
            cells = (*names, verdict(s), _SIGNS[s.better])
            table.add_row(*map(Text, cells), style=style)
            shown = s.metric
    return table


def verdict(score: Score) -> str:
    """Return value and unit; without a value, the reason and the bounds."""
    if score.value is not None:
        return _with_unit(float(score.value), score.unit)
    bounds = [
        f"{word} {_with_unit(float(number), score.unit)}"
        for word, number in (("at least", score.lower), ("at most", score.upper))
        if number is not None
    ]
    return ", ".join([f"{score.status}: {score.reason}", *bounds])


def _with_unit(number: float, unit: str) -> str:
    whole = number.is_integer() and abs(number) < 1e9
    text = str(int(number)) if whole else f"{number:.5g}"
    return text if unit in ("1", "") else f"{text} {unit}"
