"""scores.csv and the table for the terminal."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rich.console import Console

from crowdbot.core.scoring.scores_csv import (
    RunScore,
    headlines,
    read_scores_csv,
    scores_table,
    verdict,
    write_scores_csv,
)
from crowdbot.core.types.score import Score
from crowdbot.errors import InputError, hidden_character

HEADER = (
    "scenario,planner,seed,category,metric,symbol,variant,"
    "value,unit,better,status,reason,lower,upper"
)


def make(metric: str = "risk", variant: str = "corrected", **fields: Any) -> Score:
    given: dict[str, Any] = {
        "metric": metric,
        "symbol": "R",
        "category": "collision",
        "variant": variant,
        "unit": "s",
        "better": "lower",
    }
    return Score(**{**given, **fields})


SCORES = [
    make(value=2.96025, extras={"mean": 0.296025}),
    make(
        "relative_time_to_goal",
        "literal",
        symbol="T_rtg",
        category="path efficiency",
        unit="1",
        better="higher",
        status="undefined",
        reason="reference_goal_not_reached",
    ),
    make(
        "relative_time_to_goal",
        symbol="T_rtg",
        category="path efficiency",
        unit="1",
        better="higher",
        status="censored",
        reason="goal_not_reached",
        upper=10 / 11,
    ),
    make("collision_count", symbol="C", unit="1", value=123456.0),
    make(
        "neighbour_velocity_similarity",
        symbol="D_v|N",
        category="crowd-robot interaction",
        better="reference",
        status="censored",
        reason="unfinished_trips",
        lower=0.5,
        upper=1.25,
    ),
]


# ------------------------------------------------------------------------- csv
def test_columns_and_cells(tmp_path: Path) -> None:
    file = tmp_path / "scores.csv"
    write_scores_csv(file, SCORES[:3], "counter, dense", "dwa", 7)
    lines = file.read_bytes().decode("utf-8").split("\r\n")
    assert lines[0] == HEADER
    assert lines[1] == '"counter, dense",dwa,7,collision,risk,R,corrected,2.96025,s,lower,ok,,,'
    assert lines[3].endswith(",,1,higher,censored,goal_not_reached,,0.9090909090909091")
    assert lines[4:] == [""]


def test_what_is_written_is_read(tmp_path: Path) -> None:
    file = tmp_path / "scores.csv"
    write_scores_csv(file, SCORES, "s", "p", 3)
    rows = read_scores_csv(file)
    plain = [replace(s, extras={}) for s in SCORES]
    assert rows == [RunScore(scenario="s", planner="p", seed=3, score=s) for s in plain]


TEXT = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=20)


@given(
    value=st.floats(allow_nan=False, allow_infinity=False),
    texts=st.tuples(TEXT, TEXT, TEXT.filter(lambda text: not hidden_character(text))),
    seed=st.integers(),
)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_bit_for_bit(value: float, texts: tuple[str, str, str], seed: int, tmp_path: Path) -> None:
    scenario, planner, metric = texts
    file = tmp_path / "scores.csv"
    write_scores_csv(file, [make(metric, value=value)], scenario, planner, seed)
    (row,) = read_scores_csv(file)
    assert (row.scenario, row.planner, row.seed) == (scenario, planner, seed)
    assert row.score.metric == metric
    assert row.score.value is not None
    assert row.score.value.hex() == value.hex()
    with file.open(encoding="utf-8", newline="") as stream:
        assert next(iter(csv.reader(stream))) == HEADER.split(",")


def test_numbers_of_other_types_are_floats(tmp_path: Path) -> None:
    file = tmp_path / "scores.csv"
    write_scores_csv(file, [make(value=3)], "s", "p", 0)
    assert ",3.0,s," in file.read_text(encoding="utf-8")


def test_a_failed_write_leaves_the_old_file_and_no_other(tmp_path: Path) -> None:
    file = tmp_path / "scores.csv"
    write_scores_csv(file, SCORES[:1], "s", "p", 0)
    before = file.read_bytes()
    with pytest.raises(UnicodeEncodeError):
        write_scores_csv(file, SCORES, "\ud800", "p", 0)
    assert file.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["scores.csv"]


def test_nowhere_to_write(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be written"):
        write_scores_csv("/dev/null/scores.csv", SCORES, "s", "p", 0)
    (tmp_path / "folder").mkdir()
    with pytest.raises(InputError, match="cannot be written"):
        write_scores_csv(tmp_path / "folder", SCORES, "s", "p", 0)
    assert [p.name for p in tmp_path.iterdir()] == ["folder"]


GOOD = "s,p,0,collision,risk,R,corrected,1.5,s,lower,ok,,,"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", ":1: not a table of scores"),
        ("a,b\r\n", ":1: not a table of scores"),
        (f"{HEADER},more\r\n", ":1: not a table of scores"),
        (f"{HEADER}\r\n{GOOD}\r\ns,p\r\n", ":3: not a score: a row must have 14 cells"),
        (f"{HEADER}\r\n{GOOD},extra\r\n", ":2: not a score: a row must have 14 cells"),
        (f"{HEADER}\r\n{GOOD.replace('1.5', 'x')}\r\n", ":2: not a score: could not convert"),
        (f"{HEADER}\r\n{GOOD.replace('1.5', 'nan')}\r\n", ":2: not a score: .*nan"),
        (f"{HEADER}\r\n{GOOD.replace('1.5', '')}\r\n", ":2: not a score: .*status ok only"),
        (f"{HEADER}\r\n{GOOD.replace('ok', 'fine')}\r\n", ":2: not a score: status 'fine'"),
        (f"{HEADER}\r\n{GOOD.replace('lower', 'down')}\r\n", ":2: not a score: better 'down'"),
        (f"{HEADER}\r\n{GOOD.replace(',0,', ',zero,')}\r\n", ":2: not a score: invalid literal"),
        (f"{HEADER}\r\n{GOOD.replace('1.5', '1_0')}\r\n", ":2: not a score: '1_0' is not a number"),
        (f"{HEADER}\r\n{GOOD.replace('1.5', '٣')}\r\n", ":2: not a score: '٣' is not a number"),
        (f"{HEADER}\r\n{GOOD.replace(',0,', ', 0,')}\r\n", ":2: not a score: ' 0' is not a number"),
        (f'{HEADER}\r\n"s"x,p', "not a table of scores"),
    ],
)
def test_what_is_no_table_of_scores(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "scores.csv"
    file.write_bytes(text.encode())
    with pytest.raises(InputError, match=f"scores.csv.*{message}|scores.csv{message}"):
        read_scores_csv(file)


def test_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        read_scores_csv(tmp_path / "none.csv")
    (tmp_path / "latin.csv").write_bytes(f"{HEADER}\r\n\xe9".encode("latin-1"))
    with pytest.raises(InputError, match="not a table of scores"):
        read_scores_csv(tmp_path / "latin.csv")


# -------------------------------------------------------------------- terminal
def drawn(scores: list[Score], width: int = 80, *, encoding: str = "utf-8") -> str:
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding, write_through=True)
    console = Console(file=stream, width=width, color_system=None, legacy_windows=False)
    console.print(scores_table(scores))
    stream.seek(0)
    return stream.read()


def test_the_table_fits_80_columns_and_loses_nothing() -> None:
    text = drawn(SCORES)
    lines = text.splitlines()
    assert max(map(len, lines)) <= 80
    assert "…" not in text
    joined = " ".join(text.split())
    for shown in (
        "path efficiency",
        "relative_time_to_goal",
        "T_rtg",
        "reference_goal_not_reached",
        "at most 0.90909",
        "2.9602 s",
        "123456",
        " +",
        " =",
    ):
        assert shown in joined, shown


def test_headlines_are_one_a_metric_that_has_data() -> None:
    made = replace(SCORES[0], metric="m", variant="literal")
    corrected = replace(made, variant="corrected")
    unclear = replace(corrected, status="censored", reason="unfinished_trips", value=None)
    restricted = replace(made, variant="restricted")
    unasked = replace(made, metric="n", status="undefined", reason="no_command", value=None)
    assert headlines([made, corrected, unasked]) == [corrected]
    assert headlines([made, unclear, restricted]) == [restricted]
    assert headlines([made, unclear]) == [unclear]
    assert headlines([replace(made, variant="recorded")]) == [replace(made, variant="recorded")]


def test_groups_come_together_and_names_once() -> None:
    text = drawn([SCORES[1], SCORES[0], SCORES[2], SCORES[3]])
    assert (
        text.count("path efficiency") == text.count("collision\n") + text.count("collision ") == 1
    )
    assert text.count("relative_time_to_goal") == 1
    assert text.index("collision_count") < text.index("path efficiency")


def test_markup_in_names_is_text() -> None:
    assert "[red]" in drawn([make(symbol="[red]", value=1.0)])


def test_a_terminal_without_unicode() -> None:
    drawn(SCORES, encoding="ascii").encode("ascii")


@pytest.mark.parametrize(
    ("score", "text"),
    [
        (make(value=2.96025), "2.9602 s"),
        (make(value=0.8, unit="1"), "0.8"),
        (make(value=3.0, unit="1"), "3"),
        (make(value=1e300, unit="1"), "1e+300"),
        (make(value=1e-12, unit="J"), "1e-12 J"),
        (make(status="undefined", reason="no_agents"), "undefined: no_agents"),
        (make(status="censored", reason="x", lower=0.5), "censored: x, at least 0.5 s"),
        (
            make(status="censored", reason="x", lower=0.5, upper=math.pi),
            "censored: x, at least 0.5 s, at most 3.1416 s",
        ),
    ],
)
def test_verdict(score: Score, text: str) -> None:
    assert verdict(score) == text


def test_the_four_scores_come_first_and_once() -> None:
    names = [("zeta", "corrected"), ("intrusion", "rate"), ("push_work", "total"),
             ("push_work", "rate"), ("safe_efficiency", "corrected"), ("risk", "corrected"),
             ("risk", "rate")]  # fmt: skip
    scores = [
        Score(metric=m, symbol="x", category="c", unit="1", better="none", variant=v, value=1.0)
        for m, v in names
    ]
    chosen = [(s.metric, s.variant) for s in headlines(scores)]
    assert chosen == [
        ("safe_efficiency", "corrected"),
        ("push_work", "rate"),
        ("intrusion", "rate"),
        ("zeta", "corrected"),
        ("risk", "rate"),
    ]
    text = drawn(scores)
    assert text.index("the four scores") < text.index("safe_efficiency") < text.index("zeta")
    assert text.count("safe_efficiency") == 1
