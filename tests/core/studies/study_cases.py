"""A small study: two conditions, and a scenario of seconds without people."""

from __future__ import annotations

from pathlib import Path

from crowdbot.core.registry.registry import discover
from crowdbot.core.studies.document import Study, read_study

REGISTRY = discover(allow=())
SCENARIO = """crowdbot: 1
scenario:
  id: tiny
  title: A wheelchair in a corridor
  extends: ["builtin:parts/corridor_50x10.yaml", "builtin:parts/smart_wheelchair.yaml"]
  robots.robot.sensors.joystick: {kind: noisy_user}
  robots.robot.task: {start: [42 m, 0 m, 0 deg], goal: {zone: robot_goal}, time_limit: 1 s}
"""
STUDY = """crowdbot: 1
study:
  id: help
  title: Does help help?
  participants: 4
  conditions:
    alone: {planner: pass_through, title: Alone}
    blended: {planner: {kind: linear_blending, autonomy: {kind: goal_seek}}}
  trials:
    - {suite: tiny.yaml, scenario: tiny}
  consent: |
    You will drive.

    You may stop at any time.
"""


def written(folder: Path, text: str = STUDY) -> Path:
    """The path of a study, whose scenario stands beside it."""
    (folder / "tiny.yaml").write_text(SCENARIO)
    (folder / "study.yaml").write_text(text)
    return folder / "study.yaml"


def study_of(folder: Path, text: str = STUDY) -> Study:
    return read_study(written(folder, text))
