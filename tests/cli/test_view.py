from __future__ import annotations

import io
import json
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread
from numpy.typing import NDArray

from crowdbot.cli import main
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.view.build import build_map_content, field_of_view
from crowdbot.core.view.map_content import MapContent, extent
from crowdbot.core.view.png import to_png
from crowdbot.core.view.render import render
from crowdbot.core.view.shapes import DARK, LIGHT, STYLES
from crowdbot.core.view.shapes import Path as Line
from crowdbot.core.view.svg import to_svg
from crowdbot.core.view.world import LEFT, Map, nice
from crowdbot.plugin import EnvironmentParts, RobotModel

Captured = pytest.CaptureFixture[str]
REGISTRY = discover(allow=())
ONE = ["view", "challenge-2020", "counter-d0500-fast-c20-r05"]
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def svg(tmp_path_factory: pytest.TempPathFactory) -> ET.Element:
    file = tmp_path_factory.mktemp("view") / "one.svg"
    assert main([*ONE, "--out", str(file)]) == 0
    return ET.fromstring(file.read_text(encoding="utf-8"))


def of_role(svg: ET.Element, prefix: str) -> list[ET.Element]:
    return [e for e in svg.iter() if e.get("class", "").startswith(prefix)]


def texts(svg: ET.Element) -> list[str]:
    return [e.text or "" for e in svg.iter(f"{SVG}text")]


def test_everybody_is_drawn_where_they_start(svg: ET.Element) -> None:
    scenario = pick(open_spec("challenge-2020", REGISTRY), ONE[2])
    people = realise(scenario)
    content = build_map_content(scenario, people, REGISTRY)
    discs = of_role(svg, "person-")
    assert len(discs) == len(people) == 200
    top = next(float(r.get("y", "nan")) for r in svg.iter(f"{SVG}rect"))
    world = Map.around(extent(content), top)
    for i, disc in enumerate(discs):
        x, y = float(disc.get("cx", "nan")), float(disc.get("cy", "nan"))
        assert (x - LEFT) / world.scale + world.x0 == pytest.approx(people.x[i], abs=0.01)
        assert world.y1 - (y - top) / world.scale == pytest.approx(people.y[i], abs=0.01)
        assert float(disc.get("r", "nan")) / world.scale == pytest.approx(0.33, abs=0.001)
        about = disc.findtext(f"{SVG}title", "")
        assert about == f"agent {i}, {people.speed[i]:.2f} m/s, then portal"


def test_everything_has_its_name(svg: ET.Element) -> None:
    values = texts(svg)
    for name in ("robot_spawn", "crowd", "robot_goal (goal)", "portal a", "portal b", "robot"):
        assert name in values
    assert any("people: 200" in t and "0.5 1/m² in crowd at the start" in t for t in values)
    assert sum("cb1-sha256:" in t for t in values) == 2
    assert {"wall", "wall for robots only", "its goal", "m", "5 m"} <= set(values)


def test_counterflow_walks_to_the_first_portal(svg: ET.Element) -> None:
    shafts = [e for e in of_role(svg, "arrow") if e.get("d", "").count("L") == 1]
    assert len(shafts) >= 200
    for shaft in shafts[:200]:
        x0, _, x1, _ = map(float, re.findall(r"[-\d.]+", shaft.get("d", "")))
        assert x1 < x0


def test_the_picture_is_clean_text(svg: ET.Element) -> None:
    used = {e.get("class", "") for e in svg.iter()} - {"", "view"}
    assert used <= set(STYLES)
    colours = {look.fill for look in STYLES.values()} | {look.stroke for look in STYLES.values()}
    assert colours - {""} <= set(LIGHT)
    assert set(LIGHT) == set(DARK)


@pytest.mark.slow
def test_every_format_shows_the_same_twice(tmp_path: Path) -> None:
    for suffix in ("svg", "html", "png"):
        files = [tmp_path / f"{n}.{suffix}" for n in "ab"]
        for file in files:
            assert main([*ONE, "--out", str(file)]) == 0
        assert files[0].read_bytes() == files[1].read_bytes()
    assert {p.suffix for p in tmp_path.iterdir()} == {".svg", ".html", ".png"}


@pytest.mark.slow
def test_png_has_the_colours_of_what_it_shows(tmp_path: Path) -> None:
    file = tmp_path / "one.png"
    assert main([*ONE, "--out", str(file)]) == 0
    pixels = (imread(io.BytesIO(file.read_bytes()))[..., :3] * 255).round().astype(int)
    assert pixels.shape[1] > 2000
    for name, least in (("robot", 200), ("wall", 5000), ("page", 50_000), ("speed_7", 1000)):
        wanted = [int(LIGHT[name][i : i + 2], 16) for i in (1, 3, 5)]
        assert np.all(pixels == wanted, axis=2).sum() > least, name


class _Requests(HTMLParser):
    """Everything by which a page could ask for something, and its policy."""

    def __init__(self) -> None:
        super().__init__()
        self.policy, self.found = "", list[str]()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if given.get("http-equiv") == "Content-Security-Policy":
            self.policy = given["content"] or ""
        self.found += [tag] if tag in ("script", "link", "img", "iframe") else []
        self.found += [k for k in given if k in ("src", "href", "style") or k.startswith("on")]


def test_the_page_asks_for_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(ONE) == 0
    text = (tmp_path / f"{ONE[2]}.html").read_text(encoding="utf-8")
    reader = _Requests()
    reader.feed(text)
    assert reader.found == []
    assert reader.policy.startswith("default-src 'none'; style-src 'sha256-")
    assert "unsafe" not in reader.policy
    assert text.count("<style>") == 1
    assert "url(http" not in text


def test_names_are_escaped(tmp_path: Path, capsys: Captured) -> None:
    file = tmp_path / "x.yaml"
    main(["expand", "challenge-2020", "--one", ONE[2]])
    shown = capsys.readouterr().out.replace("robot_spawn:", '"<script>":')
    file.write_text(shown, encoding="utf-8")
    for suffix in ("svg", "html"):
        out = tmp_path / f"x.{suffix}"
        assert main(["view", str(file), "--out", str(out)]) == 0
        assert "<script>" not in out.read_text(encoding="utf-8")
        assert "&lt;script&gt;" in out.read_text(encoding="utf-8")


@pytest.mark.slow
def test_without_people_or_robots(tmp_path: Path) -> None:
    for change in ("crowd=null", "robots={}"):
        for suffix in ("png", "html"):
            assert main([*ONE, "--set", change, "--out", str(tmp_path / f"x.{suffix}")]) == 0


def test_json_and_set(tmp_path: Path, capsys: Captured) -> None:
    file = tmp_path / "x.svg"
    argv = [*ONE, "--out", str(file), "--json", "--set", "crowd.flow.density=0.25"]
    assert main(argv) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["path"] == str(file)
    assert document["facts"]["people"] == "100"


@pytest.mark.parametrize(
    ("argv", "code", "words"),
    [
        ([*ONE, "--out", "x.jpg"], 2, "must end in .html, .svg or .png"),
        ([*ONE, "--out", "/dev/null/x.svg"], 1, "cannot be written"),
        (["view", "challenge-2020"], 1, "no id was given"),
        (["view", "challenge-2020", "in"], 1, "fits more than one"),
        (["view", "run"], 1, "no run.json"),
        (["view", "run", "in"], 2, "in is not a run directory"),
        (["view", "run", "run"], 1, "no readable run.json"),
        (["view", "run", "--out", "x.png"], 2, "must end in .html"),
        (["view", "run", "--set", "seed=1"], 2, "no --set"),
        (["view", "challenge-2020", "a", "b"], 2, "are several"),
        (["view", "challenge-2020", "a", "--reference", "crowdbot"], 2, "is not a run"),
    ],
)
def test_wrong_commands(
    argv: list[str], code: int, words: str, tmp_path: Path, capsys: Captured,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    (tmp_path / "run").mkdir()
    assert main(argv) == code
    assert words in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [tmp_path / "run"]


def test_a_run_has_its_page(tmp_path: Path, capsys: Captured) -> None:
    (tmp_path / "run.json").write_text("{}")
    assert main(["view", str(tmp_path)]) == 1
    assert "no replay.html" in capsys.readouterr().err
    (tmp_path / "replay.html").write_text("x")
    assert main(["view", str(tmp_path)]) == 0
    assert capsys.readouterr().out == f"{tmp_path / 'replay.html'}\n"


def test_everything_an_environment_may_have() -> None:
    parts = EnvironmentParts(
        walls=np.array([[0.0, 0, 4, 0], [4, 0, 4, 3], [4, 3, 0, 3]]),
        wall_heights=np.tile([0.0, 2.0], (3, 1)),
        stops_robot=np.array([True, True, False]),
        stops_crowd=np.array([True, False, True]),
        zones={},
        portals={},
        pillars=np.array([[1.0, 1.0, 0.25]]),
        pillar_heights=np.array([[0.0, 2.0]]),
        periodic_boundary=(0.0, 4.0, 0.0, 3.0),
    )
    drawing = render(
        MapContent(parts=parts, people=Realisation.nobody()), "t", {"a": "b"}, heading=True
    )
    svg = ET.fromstring(to_svg(drawing))
    roles = {e.get("class", "") for e in svg.iter()}
    assert {"wall", "wall-robot", "wall-crowd", "pillar", "torus"} <= roles
    (pillar,) = of_role(svg, "pillar")
    wall = next(e for e in of_role(svg, "wall") if e.get("class") == "wall")
    x0, _, x1, _ = map(float, re.findall(r"[-\d.]+", wall.get("d", "")))
    assert float(pillar.get("r", "nan")) == pytest.approx((x1 - x0) / 4.0 * 0.25, abs=0.01)
    assert to_png(drawing)[:8] == b"\x89PNG\r\n\x1a\n"


def test_a_folder_in_the_way(tmp_path: Path, capsys: Captured) -> None:
    (tmp_path / "x.svg").mkdir()
    assert main([*ONE, "--out", str(tmp_path / "x.svg")]) == 1
    assert "cannot be written" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["x.svg"]


@pytest.mark.parametrize(
    ("outline", "points"),
    [(np.array([[0.4, -0.2], [0.4, 0.2], [-0.3, 0.2], [-0.3, -0.2]]), 4),
     (np.array([[-0.3, 0.0], [0.4, 0.0]]), 26)],
)  # fmt: skip
def test_a_robot_that_is_no_disc(
    outline: NDArray[np.float64], points: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its outline is drawn where it stands and as it is turned; its name clears all of it."""
    scenario = pick(open_spec("challenge-2020", REGISTRY), ONE[2])
    plain: Any = Registry.build

    def build(registry: Registry, spec: object, *more: object) -> object:
        built = plain(registry, spec, *more)
        return replace(built, footprint=outline) if isinstance(built, RobotModel) else built

    monkeypatch.setattr(Registry, "build", build)
    content = build_map_content(scenario, Realisation.nobody(), REGISTRY)
    (robot,) = content.robots
    assert len(robot.outline) == points
    assert max(x for x, _ in robot.outline) == pytest.approx(
        robot.x + 0.4 + (0.178 if len(outline) == 2 else 0.0)
    )
    assert robot.radius >= 0.44
    drawing = render(content, "x", {}, heading=False)
    (body,) = [s for s in drawing.shapes if isinstance(s, Line) and s.role == "robot" and s.inside]
    assert len(body.points) == points
    assert body.closed


def test_fields_of_view() -> None:
    robot = pick(open_spec("challenge-2020", REGISTRY), ONE[2]).robots["robot"]
    seen = field_of_view(robot.sensors["front_lidar"])
    assert seen is not None
    assert [round(v, 4) for v in seen] == [-2.0944, 2.0944, 10.0]
    assert field_of_view(robot.sensors["odometry"]) is None


@pytest.mark.parametrize(("least", "step"), [(0.3, 0.5), (1.0, 1), (1.01, 2), (4.7, 5), (6, 10)])
def test_steps_are_round(least: float, step: float) -> None:
    assert nice(least) == pytest.approx(step)


@pytest.mark.slow
def test_nothing_heavy_is_imported(tmp_path: Path) -> None:
    code = (
        "import sys\nfrom crowdbot.cli import main\n"
        f"assert main({[*ONE, '--out', str(tmp_path / 'x.svg')]!r}) == 0\n"
        "print([m for m in ('numba', 'pydrake', 'matplotlib') if m in sys.modules])"
    )
    argv = [sys.executable, "-c", code]
    done = subprocess.run(argv, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.slow
def test_runs_beside_each_other(tmp_path: Path, capsys: Captured) -> None:
    """Two real runs become one page; a page can be made anew; runs of others are refused."""
    other_id = "in-d0125-slow-c01-r02"
    for planner, id_ in (("goal_seek", ONE[2]), ("stop_and_go", ONE[2]), ("goal_seek", other_id)):
        words = ["simulate", ONE[1], id_, "--planner", planner, "--out", str(tmp_path)]
        short = ["--set", "robots.robot.task.time_limit=0.5", "--no-references", "-q"]
        assert main([*words, *short, "--record", "all"]) == 0

    def made(planner: str, id_: str = ONE[2]) -> str:
        (found,) = tmp_path.glob(f"{ONE[1]}/{id_}*/{planner}/seed-0")
        return str(found)

    runs = [made("goal_seek"), made("stop_and_go")]
    out = tmp_path / "compare.html"
    capsys.readouterr()
    assert main(["view", *runs, "--out", str(out), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["path"] == str(out)
    text = out.read_text(encoding="utf-8")
    (meta,) = re.findall(r'id="meta">(.*?)</script>', text)
    shown = json.loads(meta)["runs"]
    assert [run["label"] for run in shown] == ["goal_seek", "stop_and_go"]
    assert {wall[4] for run in shown for wall in run["walls"]} == {1, 3}
    assert all(run["robots"][0]["look"] and run["cameras"] for run in shown)
    assert "blob-1-people" in text

    again = tmp_path / "again.html"
    assert main(["view", runs[0], "--out", str(again)]) == 0
    first = (Path(runs[0]) / "replay.html").read_bytes()
    assert again.read_bytes() == first
    among = tmp_path / "among.html"
    capsys.readouterr()
    argv = ["view", *runs, "--reference", str(tmp_path), "--out", str(among)]
    assert main(argv) == 0
    assert among.read_text(encoding="utf-8").count("of 3 by safe efficiency: ") == 2
    assert main(["view", runs[0], "--reference", "crowdbot", "--out", str(among)]) == 1
    assert "no reference run of" in capsys.readouterr().err
    assert main(["view", runs[0], made("goal_seek", other_id), "--out", str(out)]) == 2
    assert "only runs of one scenario" in capsys.readouterr().err
    (Path(runs[1]) / "run.mcap").write_bytes(b"")
    assert main(["view", *runs, "--out", str(out)]) == 1
    assert "run.mcap has 0 bytes" in capsys.readouterr().err
