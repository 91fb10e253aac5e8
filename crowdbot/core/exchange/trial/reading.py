"""Convert trials of the original CrowdBot simulator to scenes."""

from __future__ import annotations

from collections.abc import Sequence

from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Draft, id_of, name_of
from crowdbot.core.exchange.trial.config import CONFIG, find_trials
from crowdbot.core.exchange.trial.endings import read_endings
from crowdbot.core.exchange.trial.law import CONTROL_LAWS
from crowdbot.core.exchange.trial.people import (
    AGENT,
    PLAYER,
    POSE,
    Policies,
    read_people,
    read_player,
)
from crowdbot.core.exchange.trial.replays import Replays
from crowdbot.core.exchange.trial.robots import ROBOT, read_robots
from crowdbot.core.exchange.trial.sims import SIMS
from crowdbot.core.exchange.trial.stage import OBSTACLES, SCENE, read_stage
from crowdbot.core.exchange.umans.policies import read_policies

TRIAL = RowTable(
    "Trial",
    (
        Row("screenRecorder", "", "crowdbot view and replay make pictures and films of a run"),
        Row("config", "", "crowdbot has its own settings"),
        Row("spawners", "", "they are the generator's: the people that it placed are here"),
    ),
)


def read(files: Sequence[OpenedScene], context: Context) -> list[Draft]:
    """Return one scene for each trial that the files are, or name.

    Raises:
        SpecError: a file that is named is missing, or a value is invalid.
    """
    policies: Policies = {}
    for file in files:
        for root in file.roots:
            if root.name == "Policies":
                policies = {**policies, **read_policies(root, context.report)}
    trials = find_trials(files, context)
    if not trials.files:
        files[0].roots[0].refuse("no trial is named here, and none was given")
    scenes = []
    for trial in trials.files:
        for root in trial.roots:
            root.used = True
            replays = Replays(trial.path, f"{context.name}.{name_of(trial.path.stem)}.csv",
                              trials.words)  # fmt: skip
            scenes.append(_scene(root, trial, policies, replays, context))
            context.report.rest(root)
    return scenes


def _scene(
    root: Item, trial: OpenedScene, policies: Policies, replays: Replays, context: Context
) -> Draft:  # fmt: skip
    report, scene = context.report, Draft(id_of(trial.path.stem))
    scene.origins[()] = root.mark
    stage = root.find("scene")
    read_stage(stage, root.find("obstacles"), scene, report)
    read_robots(root.find("robots"), scene, context)
    read_player(root.find("player"), policies, scene, replays, report)
    read_people(root.find("agents"), policies, scene, replays, report)
    read_endings(stage.find("endingConditions") if stage else None, scene, report)
    for row in TRIAL.rows:
        if (item := root.find(row.theirs)) is not None:
            report.left_out(item, row.note)
    _routing(root, scene, report)
    _one_person(scene, root, report)
    scene.title = f"Trial {trial.path.stem}"
    scene.notes.append(f"Imported from the original's trial {trial.path.name}.")
    scene.notes.append("Our x is the trial's y, our y its x; headings turn the other way.")
    return scene


def _routing(root: Item, scene: Draft, report: Report) -> None:
    """Choose paths round walls where people have goals and the stage has walls."""
    solid = any(scene.environment.get(kind) for kind in ("walls", "blocks", "pillars"))
    if solid and any(item.name == "LawGoals" for item in root.walk()):
        scene.crowd["routing"] = {"kind": "mesh"}
        report.added("crowd.routing", "LawGoals finds its way on the stage's navigation mesh")


def _one_person(scene: Draft, root: Item, report: Report) -> None:
    """Add a person who stands far off where there are neither people nor robots."""
    if scene.agents or scene.robots:
        return
    from crowdbot.core.exchange.umans.presets import preset

    policy = scene.policy(preset(0), "preset_0", root.mark)
    row = {"x": 0.0, "y": 0.0, "speed": 1.3, "goals": [[0.0, 0.0]], "policy": policy}
    scene.agent(row, root.mark, "not in the trial, which has neither people nor robots")
    report.added("crowd.agents", "one person, since the trial has no one", root.mark)


def _is_order(file: OpenedScene) -> bool:
    lines = [line.strip() for line in file.text.split("\n") if line.strip()]
    return file.kind == "text" and bool(lines) and all(ln.endswith(".xml") for ln in lines)


TRIALS = SceneFormat(
    "trial",
    "the original's trials",
    lambda file: bool(file.tags & {"Trial", "Config"}) or _is_order(file),
    read,
    (
        CONFIG,
        SCENE,
        OBSTACLES,
        PLAYER,
        ROBOT,
        POSE,
        AGENT,
        TRIAL,
        *CONTROL_LAWS.values(),
        *SIMS.values(),
    ),
    "looks and animations of bodies, cameras of the screen",
)
