"""From runs to the leaderboard through the command line, with real simulations."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import crowdbot
from crowdbot import cli
from crowdbot.core.bundle import entries as entries_module
from crowdbot.core.bundle.entries import load_entries
from crowdbot.core.runs.record_parts import ExcusedPart
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.sim import simulate as simulating
from crowdbot.core.support.json_digest import digest
from tests.core.bundle.made_up_runs import make_bundle, registry, rewrite, write_suite
from tests.waiting import AT_MOST

pytestmark = pytest.mark.slow

PLANNER = """\
class Steady:
    needs = ()
    def __init__(self, speed=0.3):
        self.speed = speed
    def reset(self, task, limits, sensors, seed):
        pass
    def step(self, obs):
        return (self.speed, 0.1)
class Other(Steady):
    pass
"""

WEIGHTED = """\
from pathlib import Path
class Weighted:
    needs = ()
    data = ("weights.txt",)
    def reset(self, task, limits, sensors, seed):
        self.speed = float(Path(__file__).with_name("weights.txt").read_text())
    def step(self, obs):
        return (self.speed, 0.0)
"""

EMPTY = """\
crowdbot: 1
suite: {id: empty}
base:
  extends: ["builtin:parts/corridor_50x10.yaml", "builtin:parts/turtlebot2.yaml"]
  robots.robot.task: {start: [2.5 m, 0 m, 0 deg], goal: {zone: robot_goal}, time_limit: 2 s}
matrix:
  limit:
    slow: {robots.robot.task.time_limit: 1 s}
    fast: {robots.robot.task.time_limit: 2 s}
"""

Verify = Callable[..., tuple[int, dict[str, Any]]]


def run_and_bundle(folder: Path, bundle: str, out: str, *more: str) -> None:
    """Run both scenarios through the command line, and pack what came of it."""
    suite, runs = folder / "tiny.yaml", folder / out
    for scenario in open_spec(str(suite), registry()).scenarios:
        assert cli.main([
            "-q", "simulate", str(suite), scenario.id, "--planner", f"{folder / 'mine.py'}:Steady",
            "--planner-set", "speed=0.4", "--record", "none", "--out", str(runs), *more,
        ]) == 0  # fmt: skip
    label = next((runs / "tiny").glob("*/*")).name
    assert cli.main([
        "bundle", str(runs), "--suite", str(suite), "--planner", label,
        "--out", str(folder / bundle), "--team", "Us", "--recordings",
    ]) == 0  # fmt: skip


@pytest.fixture(scope="module")
def world(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A suite of two scenarios of one second, and a planner of our own that has run them."""
    folder = tmp_path_factory.mktemp("world")
    suite = write_suite(folder)
    text = suite.read_text(encoding="utf-8")
    suite.write_text(text.replace("flow: in,", "flow: in, speed: slow,"), encoding="utf-8")
    assert cli.main(["lock", str(suite)]) == 0
    (folder / "mine.py").write_text(PLANNER, encoding="utf-8")
    run_and_bundle(folder, "team.cbz", "runs")
    return folder


@pytest.fixture
def verify(world: Path, capsys: pytest.CaptureFixture[str]) -> Verify:
    def call(bundle: Path, *more: str, planner: bool = True) -> tuple[int, dict[str, Any]]:
        own = ["--source", f"{world / 'mine.py'}:Steady"] if planner else []
        capsys.readouterr()
        code = cli.main(["verify", str(bundle), "--suite", str(world / "tiny.yaml"), "--json",
                         *own, *more])  # fmt: skip
        captured = capsys.readouterr()
        assert "Traceback" not in captured.err
        return code, json.loads(captured.out) if captured.out else {"err": captured.err}

    return call


def test_an_honest_bundle_is_verified(world: Path, verify: Verify) -> None:
    code, found = verify(world / "team.cbz", "--all", "--save")
    assert (code, found["outcome"], found["findings"]) == (0, "verified", [])
    assert set(found["runs"].values()) == {"identical"}
    assert len(found["runs"]) == 2
    saved = json.loads((world / "team.verified.json").read_text())
    assert saved["sha256"] == found["sha256"]


@pytest.mark.parametrize(
    ("option", "value", "key"),
    [("--planner-memory", "6", "planner_memory"), ("--planner-memory", "0", "planner_memory"),
     ("--step-budget", "5", "step_budget")],
)  # fmt: skip
def test_what_a_planner_may_take_is_part_of_an_honest_bundle(
    world: Path, verify: Verify, option: str, value: str, key: str
) -> None:
    name = f"{key}-{value}"
    run_and_bundle(world, f"{name}.cbz", name, option, value)
    record = next((world / name / "tiny").rglob("run.json"))
    assert key in json.loads(record.read_text(encoding="utf-8"))
    code, found = verify(world / f"{name}.cbz", "--all")
    assert (code, found["outcome"], found["findings"]) == (0, "verified", [])


def test_replaced_draws_are_made_again_and_not_believed(
    world: Path, verify: Verify, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An honest one is verified; without its draw, and where nobody was struck, it is not."""

    def excuse(_: object, __: object, realisation: str, draw: int) -> ExcusedPart | None:
        part = ExcusedPart(draw=draw, person=3, struck_time=0.5, toppled_time=0.75,
                           realisation=realisation, trajectory=f"cb1-sha256:{draw}")  # fmt: skip
        return None if draw else part

    with monkeypatch.context() as struck:
        struck.setattr(simulating, "excuse_of", excuse)
        run_and_bundle(world, "again.cbz", "again", "--replace-draws", "1")
        code, found = verify(world / "again.cbz", "--all")
        assert (code, found["outcome"], found["findings"]) == (0, "verified", [])

        def hidden(content: bytes) -> bytes:
            record = json.loads(content)
            assert len(record.pop("excused")) == 1
            return json.dumps(record).encode()

        label = next((world / "again" / "tiny").glob("*/*")).name
        assert cli.main(["bundle", str(world / "again"), "--suite", str(world / "tiny.yaml"),
                         "--planner", label, "--out", str(world / "bare.cbz"),
                         "--team", "Us"]) == 0  # fmt: skip
        with zipfile.ZipFile(world / "bare.cbz") as archive:
            name = next(n for n in archive.namelist() if n.endswith("seed-0/run.json"))
        silent = rewrite(world / "bare.cbz", {name: hidden}, honest=True)
        code, found = verify(silent, "--all")
        assert (code, found["outcome"]) == (1, "suspicious"), found
        assert any("excused is claimed to be None" in f for f in found["findings"])
    # Here its robot was not struck.
    code, found = verify(world / "again.cbz", "--all")
    assert (code, found["outcome"]) == (1, "suspicious")
    assert set(found["runs"].values()) == {"different"}


def test_the_seed_names_the_sample(world: Path, verify: Verify) -> None:
    chosen = [
        [*verify(world / "team.cbz", "--sample", "1", "--seed", "1")[1]["runs"]] for _ in range(2)
    ]
    assert chosen[0] == chosen[1]
    assert len(chosen[0]) == 1


def forged(world: Path) -> Path:
    """A forger improves one score of each run and lets every hash follow."""

    def improve(content: bytes) -> bytes:
        rows = content.split(b"\r\n")
        better = [r.replace(b",0.0,", b",1.0,", 1) if b",spl," in r else r for r in rows]
        return b"\r\n".join(better)

    names = zipfile.ZipFile(world / "team.cbz").namelist()
    return rewrite_stored(world, {n: improve for n in names if n.endswith("scores.csv")})


def rewrite_stored(world: Path, change: Any) -> Path:
    """`rewrite` without the recordings, which a bundle need not have."""
    bundle = world / "team.cbz"
    drop = {n: (lambda _: None) for n in zipfile.ZipFile(bundle).namelist()
            if "/references/" in n or n.endswith(".mcap")}  # fmt: skip
    return rewrite(bundle, {**drop, **change}, honest=True)


def test_a_forged_score_is_suspicious(world: Path, verify: Verify) -> None:
    code, found = verify(forged(world), "--all")
    assert (code, found["outcome"]) == (1, "suspicious")
    assert "is claimed to be 1.0, but the same trajectory gives 0.0" in found["findings"][0]


def test_a_forged_record_is_suspicious(world: Path, verify: Verify) -> None:
    names = zipfile.ZipFile(world / "team.cbz").namelist()

    def forge(**changes: Any) -> Path:
        def change(content: bytes) -> bytes:
            return json.dumps(json.loads(content) | changes).encode()

        own = [n for n in names if n.endswith("run.json") and "/references/" not in n]
        return rewrite_stored(world, dict.fromkeys(own, change))

    code, found = verify(forge(status="arrived", goal_time=0.5), "--sample", "0")
    assert (code, found["outcome"]) == (1, "invalid")  # success says something else
    code, found = verify(forge(status="planner_failed"))
    assert (code, found["outcome"]) == (1, "suspicious")
    assert "status is claimed to be 'planner_failed', but is 'timeout'" in found["findings"][0]


def test_a_tampered_member_is_invalid_and_nothing_is_simulated(world: Path, verify: Verify) -> None:
    name = next(n for n in zipfile.ZipFile(world / "team.cbz").namelist() if "scores.csv" in n)
    plain = rewrite_stored(world, {})
    changed = rewrite(plain, {name: lambda c: c + b"\r\n"})
    code, found = verify(changed)
    assert (code, found["outcome"], found["runs"]) == (1, "invalid", {})
    assert f"{name} is not what the manifest says; it was changed" in found["findings"]


def test_a_planner_that_is_not_here_cannot_be_re_run(world: Path, verify: Verify) -> None:
    code, found = verify(world / "team.cbz", planner=False)
    assert (code, found["outcome"]) == (1, "cannot be re-run")
    assert "or what the team sealed: --source" in found["findings"][0]
    (world / "other").mkdir(exist_ok=True)
    (world / "other" / "mine.py").write_text(PLANNER.replace("0.1", "0.2"), encoding="utf-8")
    other = f"{world / 'other' / 'mine.py'}:Steady"
    code, found = verify(world / "team.cbz", "--source", other, planner=False)
    assert "is not the file that the bundle was made with" in found["findings"][0]
    code, found = verify(
        world / "team.cbz", "--planner", f"{world / 'mine.py'}:Other", planner=False
    )
    assert (code, found["outcome"]) == (1, "cannot be re-run")
    assert "is not the class that the bundle was made with: Steady" in found["findings"][0]


def test_nothing_need_be_simulated(world: Path, verify: Verify) -> None:
    code, found = verify(world / "team.cbz", "--sample", "0", planner=False)
    assert (code, found["outcome"]) == (0, "not re-run")


def test_foreign_versions_are_compared_within_tolerance(world: Path, verify: Verify) -> None:
    """A bundle of another release whose trajectories differ: nobody is accused of that."""
    from crowdbot.core.runs import provenance

    versions = {**provenance.versions(), "numpy": "9.9.9"}

    def foreign(content: bytes) -> bytes:
        record = json.loads(content) | {"versions": versions}
        identity = {k: record[k] for k in ("scenario", "suite", "planner", "seed", "versions",
                                           "plugins")}  # fmt: skip
        hashes = {k: v for k, v in record["hashes"].items() if k != "trajectory"}
        record["hashes"]["trajectory"] = "cb1-sha256:0"
        record["run_id"] = digest({**identity, "hashes": hashes})
        return json.dumps(record).encode()

    def manifest(content: bytes) -> bytes:
        document = json.loads(content) | {"versions": versions}
        for run in document["runs"]:
            run["trajectory"] = "cb1-sha256:0"
            run["run_id"] = json.loads(foreign(records[f"{run['directory']}/run.json"]))["run_id"]
        return json.dumps(document).encode()

    with zipfile.ZipFile(world / "team.cbz") as file:
        records = {n: file.read(n) for n in file.namelist() if n.endswith("/run.json")}
    own = {n: foreign for n in records if "/references/" not in n}
    bundle = rewrite_stored(world, {**own, "bundle.json": manifest})
    code, found = verify(bundle, "--all")
    assert (code, found["outcome"]) == (0, "within tolerance")
    assert set(found["runs"].values()) == {"different_platform"}


@pytest.fixture(scope="module")
def empty(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A bundle of two runs without people: nothing to compile for another processor."""
    folder = tmp_path_factory.mktemp("empty")
    suite = folder / "empty.yaml"
    suite.write_text(EMPTY, encoding="utf-8")
    (folder / "mine.py").write_text(PLANNER, encoding="utf-8")
    for speed in ("slow", "fast"):
        assert cli.main([
            "-q", "simulate", str(suite), speed, "--planner", f"{folder / 'mine.py'}:Steady",
            "--record", "none", "--out", str(folder / "runs"),
        ]) == 0  # fmt: skip
    assert cli.main(["bundle", str(folder / "runs"), "--suite", str(suite), "--planner", "Steady",
                     "--out", str(folder / "team.cbz")]) == 0  # fmt: skip
    return folder


@pytest.mark.parametrize("libraries", [
    {},
    {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable",
     "NPY_DISABLE_CPU_FEATURES": "AVX2 FMA3"},
])  # fmt: skip
def test_two_processors(empty: Path, libraries: dict[str, str]) -> None:
    """The same bundle on a plain processor: never suspicious, whatever rounding does."""
    plain = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": "", **libraries}
    done = subprocess.run(
        [sys.executable, "-m", "crowdbot", "-q", "verify", str(empty / "team.cbz"), "--suite",
         str(empty / "empty.yaml"), "--planner", f"{empty / 'mine.py'}:Steady", "--all", "--json"],
        capture_output=True, text=True, env=os.environ | plain, timeout=AT_MOST,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["machine"]["processor"] == "generic"
    assert found["outcome"] in ("verified", "within tolerance")
    assert found["findings"] == []
    assert len(found["runs"]) == 2


def test_changed_metrics_are_scored_again_from_recordings(
    world: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = tmp_path / "own"
    own.mkdir()
    (own / "team.cbz").write_bytes((world / "team.cbz").read_bytes())
    ((known,), _) = load_entries(own, registry())
    before = {(s.metric, s.variant): s for s in known.runs[0].scores}
    monkeypatch.setattr(entries_module, "old_metrics", lambda *_: {"risk", "relative_path_length"})
    ((entry,), _) = load_entries(own, registry())
    assert entry.rescored == ("relative_path_length", "risk")
    assert entry.outdated == ()
    after = {(s.metric, s.variant): s for s in entry.runs[0].scores}
    assert after.keys() == before.keys()
    for name, score in after.items():
        assert (score.status, score.value) == (before[name].status, before[name].value), name


def test_runs_made_from_python_are_verified(world: Path, verify: Verify, tmp_path: Path) -> None:
    """They know nothing of the suite's axes, and the recordings hold their records."""
    suite = str(world / "tiny.yaml")
    for scenario in open_spec(suite, registry()).scenarios:
        made = crowdbot.simulate(
            scenario, planner=f"{world / 'mine.py'}:Steady", planner_settings={"speed": 0.4},
            out=tmp_path / "runs", suite="tiny", record="none",
        )  # fmt: skip
    assert made.record.axes == {}
    bundle = tmp_path / "team.cbz"
    assert cli.main([
        "bundle", str(tmp_path / "runs"), "--suite", suite, "--planner", made.directory.parent.name,
        "--out", str(bundle), "--team", "Us", "--recordings",
    ]) == 0  # fmt: skip
    code, found = verify(bundle, "--all")
    assert (code, found["outcome"], found["findings"]) == (0, "verified", [])


def test_suites_that_are_not_installed_must_be_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bundle = make_bundle(tmp_path)
    assert cli.main(["verify", str(bundle)]) == 1
    assert "name its file with --suite" in capsys.readouterr().err
    assert cli.main(["verify", str(bundle), "--suite", "challenge-2020"]) == 1
    assert "is of suite 'tiny', not of 'challenge-2020'" in capsys.readouterr().err
    assert cli.main(["verify", str(tmp_path / "none.cbz")]) == 1


def test_other_weights_are_another_run(
    empty: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "mine.py").write_text(WEIGHTED, encoding="utf-8")
    planner = ["--planner", f"{tmp_path / 'mine.py'}:Weighted", "--out", str(tmp_path / "runs")]

    def simulate(weights: str) -> Any:
        (tmp_path / "weights.txt").write_text(weights)
        capsys.readouterr()
        arguments = ["-q", "simulate", str(empty / "empty.yaml"), "slow", "--record", "used"]
        assert cli.main([*arguments, "--json", *planner]) == 0
        return json.loads(capsys.readouterr().out)

    def to_run(*more: str) -> tuple[int, int]:
        capsys.readouterr()
        arguments = ["campaign", str(empty / "empty.yaml"), "--only", "slow", "--no-floors"]
        assert cli.main([*arguments, "--dry-run", "--json", *planner, *more]) == 0
        plan = json.loads(capsys.readouterr().out)
        return plan["complete"], plan["to_run"]

    first = simulate("0.2")
    assert (first["reused"], first["replaced"]) == (False, [])
    assert (to_run(), to_run("--force")) == ((1, 0), (0, 1))
    second = simulate("0.4")
    assert (second["reused"], second["replaced"]) == (False, ["planner.sha256"])
    assert second["hashes"]["trajectory"] != first["hashes"]["trajectory"]
    assert simulate("0.4")["reused"]
    (tmp_path / "weights.txt").write_text("0.5")
    assert to_run() == (0, 1)


def test_bundle_check_says_what_verify_says(
    empty: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["bundle", str(empty / "runs"), "--suite", str(empty / "empty.yaml"), "--planner",
                 "Steady", "--out", str(tmp_path / "a.cbz"), "--check", "--sample", "1", "--seed",
                 "3", "--json"]  # fmt: skip
    source = f"{empty / 'mine.py'}:Steady"
    capsys.readouterr()
    code = cli.main([*arguments, "--source", source])
    document = json.loads(capsys.readouterr().out)["check"]
    assert (code, document["outcome"], len(document["runs"])) == (0, "verified", 1)
    again = ["--suite", str(empty / "empty.yaml"), "--sample", "1", "--seed", "3", "--json"]
    assert cli.main(["verify", str(tmp_path / "a.cbz"), *again, "--planner", source]) == 0
    assert json.loads(capsys.readouterr().out) == {"bundle": str(tmp_path / "a.cbz"), **document}
    assert cli.main(arguments) == 1
    assert json.loads(capsys.readouterr().out)["check"]["outcome"] == "cannot be re-run"
