from __future__ import annotations

import base64
import hashlib
import json
import re
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.recording.recording import Recording
from crowdbot.core.replay.encode import encode, summary
from crowdbot.core.replay.other_track import OtherTrack
from crowdbot.core.replay.page import write_replay
from crowdbot.core.replay.shown_run import ShownRun
from crowdbot.core.replay.three import three_source
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.score import Score
from crowdbot.errors import InputError
from tests.core.recording.recording_cases import random_run, write_run
from tests.core.replay.replay_cases import passing

EVIL = "</script><script>alert(1)</script><!-- \"'& \u2028"


class Page(HTMLParser):
    """Scripts by id, and all tags with their attributes."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.text = path.read_text(encoding="utf-8")
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.scripts: dict[str | None, str] = {}
        self.style, self.words, self._open = "", "", ""
        self._id: str | None = None
        self.feed(self.text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self._open = tag
        self._id = dict(attrs).get("id")

    def handle_endtag(self, tag: str) -> None:
        if tag == "script":
            self.scripts.setdefault(self._id, "")
        self._open = ""

    def handle_data(self, data: str) -> None:
        if self._open == "script":
            self.scripts[self._id] = self.scripts.get(self._id, "") + data
        elif self._open == "style":
            self.style += data
        else:
            self.words += data + " "

    @property
    def meta(self) -> Any:
        (run,) = json.loads(self.scripts["meta"], parse_constant=lambda c: pytest.fail(c))["runs"]
        return run

    def blob(self, name: str) -> bytes:
        return zlib.decompress(base64.b64decode(self.scripts[f"blob-0-{name}"], validate=True))

    def changes(self, name: str, count: int, columns: int) -> NDArray[np.int64]:
        """Unfold: low bytes first, then high bytes; 0, 1, 2, 3 are 0, -1, 1, -2."""
        planes = np.frombuffer(self.blob(name), np.uint8).reshape(2, count, columns).astype(int)
        words: NDArray[np.int64] = planes[0] + 256 * planes[1]
        changes: NDArray[np.int64] = (words >> 1) ^ -(words & 1)
        return changes

    def motion(self, name: str, count: int, columns: int) -> NDArray[np.float64]:
        """Undo differences of differences along rows, modulo 2^16."""
        once = np.cumsum(self.changes(name, count, columns), axis=1)
        return self.signed(np.cumsum(once, axis=1))

    def readings(self, name: str, count: int, columns: int) -> NDArray[np.float64]:
        """Undo differences from row to row, modulo 2^16."""
        return self.signed(np.cumsum(self.changes(name, count, columns), axis=0))

    @staticmethod
    def signed(words: NDArray[np.int64]) -> NDArray[np.float64]:
        words = words % 65536
        signed: NDArray[np.int64] = np.where(words >= 32768, words - 65536, words)
        return np.where(signed == -32768, np.nan, signed)

    def floats(self, name: str, size: int, columns: int) -> NDArray[np.float64]:
        """Undo differences of bits along rows of floats of some bytes."""
        planes = np.frombuffer(self.blob(name), np.uint8).reshape(size, -1)
        bits = np.ascontiguousarray(planes.T).view(f"<u{size}").reshape(-1, columns)
        return np.cumsum(bits, axis=1, dtype=bits.dtype).view(f"<f{size}")


def score(metric: str, variant: str, value: float | None = 0.5, **more: Any) -> Score:
    return Score(
        **{
            "metric": metric,
            "symbol": "X",
            "category": "path_efficiency",
            "variant": variant,
            "unit": "1",
            "better": "higher",
            "status": "ok" if value is not None else "undefined",
            "value": value,
            **more,
        }
    )


def write(
    path: Path,
    run: Trajectories,
    scans: Sequence[ReplayScan] = (),
    scores: Sequence[Score] = (),
    title: str = "t",
    facts: Mapping[str, str] | None = None,
) -> None:
    shown = ShownRun(run=run, scans=scans, scores=scores, title=title, facts=facts or {})
    write_replay(path, shown)


SCORES = [
    score("relative_jerk", "literal", 0.25),
    score("relative_jerk", "corrected", 0.123456),
    score("effect_on_time", "corrected", None, status="censored", upper=0.98),
    score("effect_on_time", "restricted", 0.75),
    score("risk", "corrected", None, reason="no_neighbours", unit="s", better="lower"),
]
RECORDED = random_run(n=120, m=9)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Trajectories, list[ReplayScan]]:
    path = tmp_path_factory.mktemp("replay") / "run.mcap"
    write_run(path, RECORDED)
    return Recording(path).trajectories(), Recording(path).scans()


@pytest.fixture(scope="module")
def page(run: tuple[Trajectories, list[ReplayScan]], tmp_path_factory: Any) -> Page:
    path = tmp_path_factory.mktemp("page") / "replay.html"
    facts = {"Planner": "dwa", "Status": "arrived"}
    write(path, *run, SCORES, "counter-d0500", facts)
    return Page(path)


def test_positions_are_within_a_centimetre(
    page: Page, run: tuple[Trajectories, list[ReplayScan]]
) -> None:
    agents, n = run[0].agents, len(run[0].t)
    assert agents is not None
    people = page.meta["people"]
    x, y = np.split(page.motion("people", 2 * people["count"], n) * people["scale"], 2)
    for got, given in ((x.T, agents.x), (y.T, agents.y)):
        assert np.array_equal(np.isnan(got), np.isnan(given))
        assert np.nanmax(np.abs(got - given)) <= 0.01
    assert np.isnan(x).any()
    assert np.array_equal(page.floats("t", 8, n)[0], run[0].t)


def test_jumps_are_those_of_the_run(
    page: Page, run: tuple[Trajectories, list[ReplayScan]], tmp_path: Path
) -> None:
    agents = run[0].agents
    assert agents is not None
    assert agents.jump is not None
    assert page.meta["people"]["jumps"] == np.flatnonzero(agents.jump).tolist() != []
    untold = random_run(n=120, m=9)
    write_run(tmp_path / "x.mcap", type(untold)(untold.t, untold.robot, untold.agents, None))
    write(tmp_path / "x.html", Recording(tmp_path / "x.mcap").trajectories(), [], [], "", {})
    assert Page(tmp_path / "x.html").meta["people"]["jumps"] == page.meta["people"]["jumps"]


def test_robot_is_exact_to_single_precision(
    page: Page, run: tuple[Trajectories, list[ReplayScan]]
) -> None:
    robot = run[0].robot
    assert robot is not None
    rows = page.floats("robot0", 4, len(run[0].t))
    given = np.stack((robot.x, robot.y, robot.theta, robot.v, robot.w))
    assert np.array_equal(rows, given.astype("<f4"))
    (about,) = page.meta["robots"]
    zone = run[0].goal_zone
    assert zone is not None
    assert about == {
        "name": "robot",
        "zone": zone.tolist(),
        "radius": 0.2,
        "outline": [],
        "wanted": [],
        "goal": [46.5, 0.0],
        "goalRadius": 0.5,
        "goalTime": 2.25,
        "look": [],
    }


def test_the_robots_of_a_fleet_are_a_list(run: tuple[Trajectories, list[ReplayScan]]) -> None:
    """One that ended earlier stands where it was, or is gone; contacts say whose they are."""
    given, n = run[0], len(run[0].t)
    assert given.robot is not None
    early = replace(
        given,
        t=given.t[:50],
        agents=None,
        trips=None,
        robot=replace(
            given.robot, **{k: getattr(given.robot, k)[:50] for k in ("x", "y", "theta", "v", "w")}
        ),
    )
    others = [OtherTrack(name=f"b{i}", run=early, look=(), leaves=bool(i)) for i in (0, 1)]
    meta, blobs = encode(ShownRun(run=given, title="", robot="a", others=others))
    assert [robot["name"] for robot in meta["robots"]] == ["a", "b0", "b1"]
    page = Page.__new__(Page)
    page.scripts = {f"blob-0-{name}": text for name, text in blobs.items()}
    stands, gone = (page.floats(f"robot{i}", 4, n) for i in (1, 2))
    assert np.array_equal(stands[:, :50], gone[:, :50])
    assert (stands[0, 50:] == stands[0, 49]).all()
    assert (stands[3:, 50:] == 0.0).all()
    assert np.isnan(gone[:, 50:]).all()
    assert sorted(c.get("robot", 0) for c in meta["contacts"]) == [0, 0, 1, 1, 2, 2]


def test_scans_are_thinned_and_within_a_centimetre(
    page: Page, run: tuple[Trajectories, list[ReplayScan]]
) -> None:
    ((given,), (about,)) = run[1], page.meta["scans"]
    assert np.allclose(about["t"], given.t[::2])  # 16 Hz to 8 Hz
    assert np.allclose(about["angles"], given.angles, atol=1e-5)
    assert about["mount"] == list(given.mount)
    got = page.readings("scan0", len(about["angles"]), len(about["t"])).T * 0.01
    returned = np.isfinite(given.ranges[::2])
    assert np.array_equal(got > 0, returned)
    assert np.abs(got - given.ranges[::2])[returned].max() <= 0.01


def test_many_beams_are_thinned(tmp_path: Path) -> None:
    angles, t = np.linspace(-2, 2, 480), np.arange(8) / 16
    ranges = np.linspace(1, 9, 480) + t[:, None]
    scan = ReplayScan(
        sensor="a", mount=(0.0, 0.0, 0.0, 0.0), angles=angles, range_max=10.0, t=t, ranges=ranges
    )
    write_run(tmp_path / "x.mcap", random_run(n=8))
    run = Recording(tmp_path / "x.mcap").trajectories()
    write(tmp_path / "x.html", run, [scan], [], "", {})
    page = Page(tmp_path / "x.html")
    assert np.allclose(page.meta["scans"][0]["angles"], angles[::2], atol=1e-5)
    got = page.readings("scan0", 240, 4) * 0.01
    assert np.abs(got - ranges[::2, ::2].T).max() <= 0.01


def test_sonars_are_told_together() -> None:
    """Two that were read at once share their times; one with others has its own."""
    rng = np.random.default_rng(1)
    t = np.arange(40) / 16.0
    ranges = rng.uniform(0.2, 4.5, (3, 40, 1))
    ranges[0, 4] = np.inf
    cones = [
        ReplayScan(
            sensor=f"us{i}", mount=(0.1 * i, 0.0, 0.2, 0.5), angles=np.array([-0.3, 0.3]),
            range_max=4.5, t=t + (i == 2) / 32.0, ranges=ranges[i], cone=True,
        )
        for i in range(3)
    ]  # fmt: skip
    robot = {f"robot_{n}": np.zeros(2) for n in ("x", "y", "theta")}
    run = Trajectories.from_arrays(t=[0.0, 3.0], robot_radius=0.2, robot_mass=6.3, **robot)  # type: ignore[arg-type]
    meta, blobs = encode(ShownRun(run=run, title="", scans=cones))
    assert meta["scans"] == []
    assert [[s["sensor"] for s in group["sensors"]] for group in meta["cones"]] == [
        ["us0", "us1"], ["us2"],
    ]  # fmt: skip
    assert meta["cones"][0]["sensors"][1]["mount"] == [0.1, 0.0, 0.2, 0.5]
    assert meta["cones"][0]["t"] == (np.arange(20) / 8.0).tolist()
    page = Page.__new__(Page)
    page.scripts = {f"blob-0-{name}": text for name, text in blobs.items()}
    got = page.motion("cones0", 2, 20) * 0.01
    given = ranges[:2, ::2, 0]
    assert got[0, 2] == 0.0
    assert np.abs(got - np.where(np.isfinite(given), given, 0.0)).max() <= 0.0051
    assert page.motion("cones1", 1, 20).shape == (1, 20)


BOX = [[0.4, -0.2], [0.4, 0.2], [-0.3, 0.2], [-0.3, -0.2]]


@pytest.mark.parametrize(
    ("outline", "bearing", "reach", "side"),
    [
        (None, 1.0, 0.25, "left"),
        (BOX, 0.0, 0.4, "front"),
        (BOX, -0.5 * np.pi, 0.2, "right"),
        ([[-0.3, 0.0], [0.3, 0.0]], np.pi, 0.55, "rear"),
        (BOX, np.nan, 0.0, "unknown"),
    ],
)
def test_contacts_lie_on_the_robots_outline(
    outline: Any, bearing: float, reach: float, side: str
) -> None:
    table = {n: [0.5] for n in ("t0", "t1", "impulse", "peak_force", "relative_speed")}
    robot = {f"robot_{n}": np.zeros(2) for n in ("x", "y", "theta")}
    run = Trajectories.from_arrays(
        t=[0.0, 1.0], robot_radius=0.25, robot_mass=6.3, robot_footprint=outline,
        contacts={**table, "agent": [-1], "bearing": [bearing]}, **robot,  # type: ignore[arg-type]
    )  # fmt: skip
    meta, _ = encode(ShownRun(run=run, title=""))
    (contact,) = meta["contacts"]
    assert contact["reach"] == pytest.approx(reach, abs=5e-3)
    assert contact["side"] == side
    assert (contact["bearing"] is None) == np.isnan(bearing)
    assert meta["robots"][0]["outline"] == (outline or [])
    words = "1" if side == "unknown" else f"1 (1 {side})"
    assert summary(run)["Contacts"] == words


def test_contacts_name_people_by_place(page: Page) -> None:
    contacts = page.meta["contacts"]
    assert [(c["t0"], c["t1"], c["person"]) for c in contacts] == [
        (0.3, 0.40625, 1),  # id 103
        (1.0, 1.1, -1),
    ]


def test_runs_of_one_scenario_explain_its_name_once(tmp_path: Path) -> None:
    expected = "In this scenario's name, d0125: 0.125 people per m² where they start{}; slow: slow."
    densities = [", 0.1 in this run", ", 0.099 in this run"]
    shown = [replace(passing(), words=expected.format(text)) for text in densities]
    write_replay(tmp_path / "both.html", *shown)
    write_replay(tmp_path / "one.html", shown[1])
    texts = [(tmp_path / f"{name}.html").read_text("utf-8") for name in ("both", "one")]
    assert [t.count("In this scenario") for t in texts] == [1, 1]
    assert ["in this run" in t for t in texts] == [False, True]


def test_nothing_comes_from_outside(page: Page) -> None:
    text = page.text
    for name, script in page.scripts.items():
        if name and (name.startswith("blob-") or name == "three"):
            text = text.replace(script, "")  # base64 has slashes
    assert not re.search(r"fetch\(|XMLHttp|WebSocket|import\(", three_source())
    assert not re.search(r"https?:|\bwss?:|//\w|@import|url\(|fetch\(|XMLHttp", text)
    for tag, attributes in page.tags:
        assert tag not in ("link", "img", "iframe", "object", "base")
        assert not {"src", "href", "style"} & set(attributes)
        assert not any(name.startswith("on") for name in attributes)


def test_policy_allows_our_style_and_script_only(page: Page) -> None:
    policy = next(
        a["content"]
        for tag, a in page.tags
        if tag == "meta" and a.get("http-equiv") == "Content-Security-Policy"
    )

    def hashed(text: str) -> str:
        return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"

    assert policy == (
        f"default-src 'none'; "
        f"script-src {hashed(page.scripts[None])} {hashed(three_source())}; "
        f"style-src {hashed(page.style)}; frame-src 'self'; base-uri 'none'; form-action 'none'"
    )


def test_scores_and_facts_are_readable_without_script(page: Page) -> None:
    words = " ".join(page.words.split())
    for text in ("counter-d0500", "arrived", "Planner dwa", "0.1235", "≤ 0.98", "no neighbours"):
        assert text in words
    rows = [a["class"] or "" for tag, a in page.tags if tag == "tr" and "class" in a]
    assert rows == ["category", "ok extra", "ok", "censored extra", "ok", "undefined"]


def test_what_no_run_can_answer_is_shown_on_request_only(
    run: tuple[Trajectories, list[ReplayScan]], tmp_path: Path
) -> None:
    asked = score("fluency", "corrected", None, reason="no_command", category="shared control")
    path = tmp_path / "x.html"
    write(path, run[0], [], [asked], title="t", facts={})
    rows = re.findall(r'<tr class="([^"]*)"', path.read_text(encoding="utf-8"))
    assert rows == ["category extra", "undefined extra"]


def test_hostile_text_stays_text(
    run: tuple[Trajectories, list[ReplayScan]], tmp_path: Path
) -> None:
    path = tmp_path / "x.html"
    scan = run[1][0]
    evil_scan = ReplayScan(
        sensor=EVIL,
        mount=scan.mount,
        angles=scan.angles,
        range_max=scan.range_max,
        t=scan.t,
        ranges=scan.ranges,
    )
    evil_score = score(EVIL, EVIL, None, reason=EVIL, category=EVIL, symbol=EVIL, unit=EVIL)
    write(path, run[0], [evil_scan], [evil_score], EVIL, {EVIL: EVIL, "Status": EVIL})
    page, clean = Page(path), tmp_path / "clean.html"
    write(clean, run[0], [scan], [score("a", "b", None)], "t", {"f": "g", "Status": "s"})
    names = [tag for tag, _ in page.tags]
    assert names.count("script") == [tag for tag, _ in Page(clean).tags].count("script")
    assert page.meta["scans"][0]["sensor"] == EVIL
    assert page.words.count("alert(1)") >= 6
    assert all("alert" not in text for key, text in page.scripts.items() if key != "meta")


def test_equal_input_gives_equal_bytes(
    run: tuple[Trajectories, list[ReplayScan]], tmp_path: Path
) -> None:
    for name in ("a", "b"):
        write(tmp_path / name, *run, SCORES, "t", {"x": "y"})
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a", "b"]


@pytest.mark.parametrize("missing", ["robot", "agents", "everybody", "walls"])
def test_reference_runs_have_a_page(missing: str, tmp_path: Path) -> None:
    given = random_run(m=0 if missing == "everybody" else 4)
    cut = type(given)(
        given.t,
        None if missing == "robot" else given.robot,
        None if missing == "agents" else given.agents,
        None if missing == "agents" else given.jump,
    )
    write_run(tmp_path / "x.mcap", cut)
    run = Recording(tmp_path / "x.mcap").trajectories()
    if missing == "walls":
        run = Trajectories.from_arrays(
            t=run.t, agent_x=[[1e4]] * 40, agent_y=[[0.0]] * 40, agent_radius=0.3, agent_mass=70.0
        )
    write(tmp_path / "x.html", run, Recording(tmp_path / "x.mcap").scans(), [], "x", {})
    meta = Page(tmp_path / "x.html").meta
    assert len(meta["robots"]) == (run.robot is not None)
    assert (meta["people"] is None) == (run.agents is None)
    assert bool(meta["scans"]) == (run.robot is not None)
    if missing == "walls":  # too far away for centimetres
        page = Page(tmp_path / "x.html")
        far = page.motion("people", 2, 40)[0] * meta["people"]["scale"]
        assert np.allclose(far, 1e4, rtol=1e-4)
        assert meta["walls"] == []


def test_ninety_seconds_with_two_hundred_people_stay_below_a_megabyte(tmp_path: Path) -> None:
    rng, n, m = np.random.default_rng(0), 1440, 200
    t = np.arange(n) / 16
    sway = 0.05 * np.sin(2 * np.pi * 0.9 * t[:, None] + rng.uniform(0, 6, m))
    speed = rng.normal(1.2, 0.2, m) + 0.1 * rng.standard_normal((n, m)).cumsum(axis=0) / 30
    x = (rng.uniform(0, 50, m) + speed.cumsum(axis=0) / 16) % 50
    y = rng.uniform(-5, 5, m) + sway
    run = Trajectories.from_arrays(
        t=t, agent_x=x, agent_y=y, agent_radius=0.33, agent_mass=75.0,
        robot_x=0.4 * t, robot_y=0 * t, robot_theta=0 * t, robot_v=0 * t, robot_w=0 * t,
        robot_radius=0.2, robot_mass=6.0,
    )  # fmt: skip
    angles = np.linspace(-2, 2, 480)
    shape = 5 + 4 * np.sin(0.5 * t[::2, None] + 9 * angles)
    scans = [
        ReplayScan(
            sensor=name,
            mount=(0.0, 0.0, 0.3, 0.0),
            angles=angles,
            range_max=10.0,
            t=t[::2],
            ranges=shape + rng.normal(0, 0.001, shape.shape),
        )
        for name in ("front", "rear")
    ]
    write(tmp_path / "x.html", run, scans, [], "x", {})
    assert (tmp_path / "x.html").stat().st_size < 1e6


def test_an_unwritable_path_is_an_input_error(
    run: tuple[Trajectories, list[ReplayScan]],
) -> None:
    with pytest.raises(InputError, match="cannot be written"):
        write(Path("/dev/null/x.html"), run[0], [], [], "x", {})
