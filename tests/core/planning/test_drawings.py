"""What planners draw: checked, recorded, read again, shown, and compared with the truth."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

import crowdbot
from crowdbot.cli import main
from crowdbot.core.planning.planner import drawing_bounds, named_drawing
from crowdbot.core.recording.reading.one_robot import PlannerDrawing
from crowdbot.core.replay.encode_drawings import encode_drawings
from crowdbot.errors import PlannerError
from tests.core.replay.replay_cases import passing

PLANNER = """
class Draws:
    needs = ("lidar",)

    def reset(self, task, limits, sensors, seed):
        pass

    def step(self, obs):
        obs.draw("path", [[0.0, 0.0], [1.0, 0.5]])
        obs.draw("nothing", [])
        obs.draw("why", [[1.0, 0.0], [2.0, 0.0]], text=["waits", "a\\x1b[1m\\nb"])
        obs.draw("here", lambda: [[0.0, 0.0]], "one")
        return 0.2, 0.0
"""
SCENARIO = "challenge-2026", "counter-d020-attentive-n01"


def test_no_rows_have_the_columns_of_their_name() -> None:
    assert named_drawing("tracks", [])[1].shape == (0, 5)
    assert named_drawing("path", [])[1].shape == (0, 2)


def run(tmp_path: Path, planner: object, **more: object) -> crowdbot.Run:
    changes = {"robots.robot.task.time_limit": "3 s", "crowd.seed.root": 9}
    scenario = crowdbot.load(SCENARIO[0], SCENARIO[1] + "*", set=changes)
    return crowdbot.simulate(
        scenario, planner=planner, out=tmp_path / "runs", references=False,  # type: ignore[arg-type]
        metrics="success", **more,  # type: ignore[arg-type]
    )  # fmt: skip


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ([[1.0]], "rows of 2 to 16"),
        ([[1.0, float("nan")]], "not finite"),
        (np.zeros((3000, 2)), "at most 2000"),
        ([1.0, 2.0], "shape"),
    ],
)
def test_a_drawing_is_a_small_table_of_numbers(rows: object, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        named_drawing("path", rows)  # type: ignore[arg-type]


def test_tracks_have_five_columns() -> None:
    with pytest.raises(ValueError, match="number, x, y, vx, vy"):
        named_drawing("tracks", [[1.0, 2.0]])
    assert named_drawing("tracks", [[1, 2, 3, 4, 5]])[1].shape == (1, 5)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (3, "'why' has one text or a list of texts, not 3"),
        (["one"], "'why' has 2 rows, but 1 texts"),
        (["one", None], "'why' has None in place of a text"),
        ("x" * 81, "a text of 'why' has at most 80 characters, not 81"),
        (b"one", "one text or a list"),
    ],
)
def test_texts_are_short_and_as_many_as_rows(text: object, words: str) -> None:
    with pytest.raises((TypeError, ValueError), match=re.escape(words)):
        named_drawing("why", [[0.0, 0.0], [1.0, 0.0]], text)  # type: ignore[arg-type]


def test_texts_are_bounded_and_not_for_tracks() -> None:
    with pytest.raises(ValueError, match="at most 200 texts, not 201"):
        named_drawing("why", np.zeros((201, 2)), "one")
    with pytest.raises(ValueError, match="'tracks' are people, without texts"):
        named_drawing("tracks", np.zeros((1, 5)), "one")
    drawn = named_drawing("why", np.zeros((2, 2)), "a\x00b\u202ec")
    assert drawn.texts == ("abc", "abc")
    assert drawn.size == 4 + 6
    assert named_drawing("why", [], "one").texts == ()


def test_a_page_has_each_text_once() -> None:
    at = np.array([[1.0, 2.0]])
    drawn = {
        "why": [
            PlannerDrawing(0.0, at, ("waits",)),
            PlannerDrawing(0.5, at[:0], ()),
            PlannerDrawing(0.6, at),
            PlannerDrawing(1.0, np.vstack([at, at]), ("goes", "waits")),
        ],
        "plan": [PlannerDrawing(0.0, at)],
    }
    plan, why = encode_drawings(passing().run, drawn)[0]["drawings"]
    assert (why["rows"], why["texts"]) == ([1, 0, 1, 2], ["waits", "goes"])
    assert why["which"] == [0, -1, 1, 0]
    assert "texts" not in plan


class Counting:
    """Draws rows that it counts, once as a table and once on demand."""

    def __init__(self) -> None:
        self.made = self.steps = 0

    def reset(self, task: object, limits: object, sensors: object, seed: int) -> None:
        pass

    def step(self, obs: crowdbot.Observation) -> tuple[float, float]:
        self.steps += 1
        obs.draw("at once", [[0.0, obs.t]])
        obs.draw("on demand", self._rows)
        return 0.2, 0.0

    def _rows(self) -> list[list[float]]:
        self.made += 1
        return [[0.0, float(self.made)]]


@pytest.mark.parametrize(("record", "share"), [("all", 1.0), ("used", 0.5), ("none", 0.0)])
def test_rows_on_demand_are_made_only_for_what_is_kept(
    tmp_path: Path, record: str, share: float
) -> None:
    planner = Counting()
    done = run(tmp_path, planner, record=record)
    assert planner.made == round(share * planner.steps)
    with crowdbot.Recording(done.directory / "run.mcap") as recording:
        drawn = recording.drawings()
    if share:
        assert [d.t for d in drawn["on demand"]] == [d.t for d in drawn["at once"]]
        assert [d.rows[0, 1] for d in drawn["on demand"]] == list(range(1, planner.made + 1))
    else:
        assert not drawn


@pytest.mark.parametrize("record", ["used", "none"])
@pytest.mark.parametrize("name", ["", ["path"]])
def test_a_wrong_name_is_an_error_even_if_nothing_is_kept(
    tmp_path: Path, record: str, name: object
) -> None:
    class Misnames(Counting):
        def step(self, obs: crowdbot.Observation) -> tuple[float, float]:
            obs.draw(name, self._rows)  # type: ignore[arg-type]
            return 0.2, 0.0

    done = run(tmp_path, Misnames(), record=record)
    assert done.status == "planner_failed"
    assert "the name of a signal is text" in done.record.reason


def test_rows_on_demand_are_checked_too() -> None:
    with pytest.raises(ValueError, match="rows of 2 to 16"):
        named_drawing("path", lambda: [[1.0]])
    assert named_drawing("path", lambda: [[1.0, 2.0]])[1].tolist() == [[1.0, 2.0]]


@pytest.mark.parametrize("in_process", [True, False])
def test_drawings_of_a_file_are_recorded(tmp_path: Path, in_process: bool) -> None:
    file = tmp_path / "draws.py"
    file.write_text(PLANNER)
    done = run(tmp_path, f"{file}:Draws", in_process=in_process)
    with crowdbot.Recording(done.directory / "run.mcap") as recording:
        drawn = recording.drawings()
        topics = recording.info.topics
    assert topics["/thoughts"][0] == "crowdbot_msgs/msg/Drawing"
    assert topics["/thought_texts"][0] == "crowdbot_msgs/msg/DrawnTexts"
    assert set(drawn) == {"path", "nothing", "why", "here"}
    assert drawn["why"][0].texts == ("waits", "a[1m b")
    assert drawn["here"][-1].texts == ("one",)
    assert drawn["path"][0].texts is None
    assert len(drawn["path"]) >= 20  # 8 Hz for 3 s
    assert drawn["path"][0].rows.tolist() == [[0.0, 0.0], [1.0, 0.5]]
    assert drawn["nothing"][0].rows.shape == (0, 2)


def test_tracks_are_compared_with_the_truth_and_shown(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    done = run(tmp_path, "people_mpc")
    with crowdbot.Recording(done.directory / "run.mcap") as recording:
        drawn, truth = recording.drawings(), recording.trajectories()
    assert {"tracks", "plan"} <= set(drawn)
    about, blobs = encode_drawings(truth, drawn)
    assert [one["name"] for one in about["drawings"]] == sorted(drawn)
    assert set(blobs) == {f"drawing{k}" for k in range(len(drawn))}
    page = (done.directory / "replay.html").read_text()
    assert "drawThoughts" in page
    assert 'id="blob-0-drawing0"' in page
    code = main(["results", "tracking", "--runs", str(tmp_path / "runs"), "--altered", "--json"])
    assert code == 0
    near, far = json.loads(capsys.readouterr().out)
    assert (near["within"], far["within"]) == (3.0, 6.0)
    assert far["people"] > 0
    assert far["recall"] > 0.8


def test_runs_without_tracks_are_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run(tmp_path, "stand_still")
    assert main(["results", "tracking", "--runs", str(tmp_path / "runs"), "--altered"]) == 0
    assert "no run has tracks" in capsys.readouterr().out


def test_the_drawings_of_a_run_are_bounded() -> None:
    bounds = drawing_bounds()
    bounds.check("plan", 20_000_000)
    with pytest.raises(PlannerError, match="draw: more than 20000000 values of drawings"):
        bounds.check("plan")
