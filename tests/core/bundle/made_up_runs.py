"""Run directories of a tiny suite that was never simulated, and archives to tamper with."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, cast

from crowdbot.core.bundle.manifest import MANIFEST
from crowdbot.core.bundle.pack import Submission, pack
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.recording.header import RecordingHeader, RobotHeader
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.runs import provenance
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.scenarios.library import open_suite
from crowdbot.core.scenarios.lock import make_lock, write_lock
from crowdbot.core.scenarios.lock_check import spec_of
from crowdbot.core.scoring.score_factory import ScoreFactory
from crowdbot.core.scoring.scores_csv import write_scores_csv
from crowdbot.core.support.json_digest import digest
from crowdbot.core.types.score import Score
from crowdbot.dsl.identity.canonical import dump_scenario_yaml
from crowdbot.dsl.identity.crowd_likeness import fingerprint
from crowdbot.dsl.spec.metric_component import MetricComponent

TINY = """\
crowdbot: 1
extends: builtin:challenge-2020.yaml
suite: {id: tiny, title: A tiny suite}
base:
  robots.robot.task.time_limit: 1 s
only: {flow: in, density: d0125, coeff: [c01, c20], range: r02}
"""
METRICS = ("risk", "spl")


@cache
def registry() -> Registry:
    return discover(allow=())


def write_suite(folder: Path) -> Path:
    """The suite with its lock; six scenarios, three draws."""
    path = folder / "tiny.yaml"
    path.write_text(TINY, encoding="utf-8")
    expansion, lock = open_suite(str(path), registry())
    write_lock(lock, make_lock(expansion, registry(), lock))
    return path


def scores(*values: float) -> list[Score]:
    known = registry().components("metric")
    return [
        ScoreFactory(cast(MetricComponent[Any], known[m])).ok("corrected", v)
        for m, v in zip(METRICS, values, strict=True)
    ]


def versions() -> dict[str, Any]:
    known = registry().components("metric")
    return {m: {"spec_version": known[m].spec_version} for m in METRICS}


def make_runs(
    root: Path,
    suite: Path,
    planner: str = "dwa",
    value: Callable[[int], float] = float,
    seeds: tuple[int, ...] = (0,),
    **more: Any,
) -> None:
    """A complete set of runs; ``value`` of the scenario's number is each score."""
    expansion, lock = open_suite(str(suite), registry())
    choice = resolve_planner(planner, registry())
    locked = lock.lock.scenarios if lock.lock_path.exists() else {}
    people = {s.id: locked[s.id].realisation if locked else "none" for s in expansion.scenarios}
    for number, scenario in enumerate(expansion.scenarios):
        for seed in seeds:
            folder = root / expansion.suite / scenario.id / choice.label / f"seed-{seed}"
            folder.mkdir(parents=True)
            spec = spec_of(scenario, registry())
            identity: dict[str, Any] = {
                "scenario": scenario.id, "suite": expansion.suite,
                "planner": {**choice.spec_dump, "name": choice.name, "label": choice.label},
                "seed": seed,
                "hashes": {"spec": spec,
                           "realisation": people[scenario.id]},
                "versions": provenance.versions(), "plugins": [],
            }  # fmt: skip
            record = {
                "run_id": digest(identity), **identity,
                "hashes": {**identity["hashes"], "trajectory": f"cb1-sha256:{number}{seed}"},
                "pinned": choice.pinned, "privileged": choice.privileged, "status": "arrived",
                "goal_time": 0.5, "reason": "", "sim_time": 1.0, "wall_time": 0.1,
                "metrics": versions(), "density": 0.1, "reference_hashes": {},
                "machine": provenance.machine(), "references": {},
                "axes": dict(expansion.axes.get(scenario.id, {})),
                "crowd": fingerprint(scenario.crowd) if scenario.crowd else "", **more,
            }  # fmt: skip
            files.write_json(folder / files.RECORD, record)
            text = dump_scenario_yaml(scenario, registry().spec_versions(scenario))
            (folder / files.SCENARIO).write_text(text, encoding="utf-8")
            write_scores_csv(
                folder / files.SCORES, scores(value(number), value(number) / 10.0), scenario.id,
                choice.label, seed,
            )  # fmt: skip


def write_recording(
    path: Path, scenario: str, hashes: Mapping[str, str], speed: float, *, whole: bool = True
) -> str:
    """A recording of a second in which a robot drives straight on; the hash of what happens."""
    robot = RobotHeader(radius=0.2, mass=10.0)
    writer = RecordingWriter(
        path, RecordingHeader(scenario=scenario, hashes=hashes, robot=robot), record="none"
    )
    for i in range(17):
        writer.state(i / 16, (speed * i / 16, 0.0, 0.0, speed, 0.0), None)
    writer.close(0.5, whole, "arrived")
    return provenance.trajectory_hash(Recording(path).trajectories())


def record_runs(root: Path) -> None:
    """Give every run a recording, and its record the hash of that."""
    for number, file in enumerate(sorted(root.rglob("run.json"))):
        record = json.loads(file.read_text())
        hashes = provenance.recording_hashes(RunRecord.parse(record, file))
        recording = file.with_name("run.mcap")
        record["hashes"]["trajectory"] = write_recording(
            recording, record["scenario"], hashes, 0.1 * number
        )
        files.write_json(file, record)


def make_bundle(folder: Path, planner: str = "dwa", name: str = "team.cbz", **more: Any) -> Path:
    """A bundle of made-up runs."""
    suite = folder / "tiny.yaml"
    suite = suite if suite.exists() else write_suite(folder)
    root = folder / f"runs-{name}"
    options = {k: more.pop(k) for k in ("team", "partial", "recordings") if k in more}
    make_runs(root, suite, planner, **more)
    if options.get("recordings"):
        record_runs(root)
    expansion, lock = open_suite(str(suite), registry())
    label = resolve_planner(planner, registry()).label
    pack(Submission(root=root, planner=label, **options), expansion, lock, registry(),
         folder / name)  # fmt: skip
    return folder / name


def _let_digests_follow(members: dict[str, bytes], changed: set[str]) -> None:
    """Records get the digests of files that were changed beside them."""
    import hashlib

    for name in [n for n in changed if n in members and not n.endswith("run.json")]:
        folder, _, file = name.rpartition("/")
        record = json.loads(members.get(f"{folder}/run.json", b"{}"))
        if file in record.get("digests", {}):
            record["digests"][file] = hashlib.sha256(members[name]).hexdigest()
            members[f"{folder}/run.json"] = json.dumps(record).encode()


def rewrite(
    bundle: Path,
    change: Mapping[str, Callable[[bytes], bytes | None]],
    more: Mapping[str, bytes] | None = None,
    *,
    honest: bool = False,
) -> Path:
    """The same archive with other members; ``honest`` lets the manifest follow, as a forger would.

    A change that gives None removes the member.
    """
    import hashlib

    with zipfile.ZipFile(bundle) as file:
        members = {n: file.read(n) for n in file.namelist()}
        kept = {i.filename for i in file.infolist() if i.compress_type == zipfile.ZIP_STORED}
    kept |= {name for name in more or {} if honest and name.endswith(".mcap")}
    for name, function in change.items():
        changed = function(members[name])
        if changed is None:
            del members[name]
        else:
            members[name] = changed
    members |= more or {}
    if honest:
        _let_digests_follow(members, {*change, *(more or {})})
        manifest = json.loads(members[MANIFEST])
        manifest["members"] = {
            n: {"sha256": hashlib.sha256(c).hexdigest(), "size": len(c)}
            for n, c in members.items() if n != MANIFEST
        }  # fmt: skip
        members[MANIFEST] = json.dumps(manifest).encode()
    target = bundle.with_name(f"changed-{bundle.name}")
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in members.items():
            stored = name in kept
            kind = zipfile.ZIP_STORED if stored else zipfile.ZIP_DEFLATED
            file.writestr(name, content, kind)
    return target
