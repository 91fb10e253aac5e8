"""crowdbot: a benchmark for robots that drive through dense human crowds.

Names below are imported when they are first used, so that ``import crowdbot`` stays cheap.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from crowdbot.lazy import lazy_names

if TYPE_CHECKING:
    from crowdbot.api import evaluate, expand, load, results, score, simulate
    from crowdbot.core.planning.planner import NoValidCommand, Observation, Planner, Truth
    from crowdbot.core.recording.recording import Recording
    from crowdbot.core.results.results import Results
    from crowdbot.core.runs.run import Run
    from crowdbot.core.scoring.evaluate import Scores
    from crowdbot.core.sensing.points import LidarPoints
    from crowdbot.core.sim.session import Session
    from crowdbot.core.trajectories.commands import Commands
    from crowdbot.core.trajectories.questionnaires import Questionnaires
    from crowdbot.core.trajectories.trajectories import Trajectories
    from crowdbot.core.types.motion import Command, Pose
    from crowdbot.core.types.person_task import PersonEstimate, PersonTask
    from crowdbot.core.types.robot import RobotLimits
    from crowdbot.core.types.score import Score
    from crowdbot.core.types.sensor import Reading, SensorInfo
    from crowdbot.core.types.task import Task
    from crowdbot.dsl.scenario.scenario import Scenario
    from crowdbot.dsl.suite.expand import Expansion as Suite
    from crowdbot.errors import CrowdbotError, RecordingWarning

_HOMES = {
    "crowdbot.api": "Scenario evaluate expand load results score simulate",
    "crowdbot.core.planning.planner": "NoValidCommand Observation Planner Task Truth",
    "crowdbot.core.recording.from_mcap": "Trajectories",
    "crowdbot.core.recording.recording": "Recording",
    "crowdbot.core.results.results": "Results",
    "crowdbot.core.runs.run": "Run",
    "crowdbot.core.scoring.evaluate": "Scores",
    "crowdbot.core.sensing.points": "LidarPoints",
    "crowdbot.core.sim.session": "Session",
    "crowdbot.core.trajectories.commands": "Commands",
    "crowdbot.core.trajectories.questionnaires": "Questionnaires",
    "crowdbot.core.types.motion": "Command Pose",
    "crowdbot.core.types.person_task": "PersonEstimate PersonTask",
    "crowdbot.core.types.robot": "RobotLimits",
    "crowdbot.core.types.score": "Score",
    "crowdbot.core.types.sensor": "Reading SensorInfo",
    "crowdbot.dsl.suite.expand": "Expansion=Suite",
    "crowdbot.errors": "CrowdbotError RecordingWarning",
}

__all__ = [
    "Command",
    "Commands",
    "CrowdbotError",
    "LidarPoints",
    "NoValidCommand",
    "Observation",
    "PersonEstimate",
    "PersonTask",
    "Planner",
    "Pose",
    "Questionnaires",
    "Reading",
    "Recording",
    "RecordingWarning",
    "Results",
    "RobotLimits",
    "Run",
    "Scenario",
    "Score",
    "Scores",
    "SensorInfo",
    "Session",
    "Suite",
    "Task",
    "Trajectories",
    "Truth",
    "evaluate",
    "expand",
    "load",
    "results",
    "score",
    "simulate",
]


if not TYPE_CHECKING:
    __getattr__ = lazy_names(__name__, _HOMES)


def __dir__() -> list[str]:
    return sorted(__all__)
