"""Names of this package, and where they come from: for type checkers, and to import them."""

__all__: list[str]

from crowdbot.api import Suite as Suite
from crowdbot.api import evaluate as evaluate
from crowdbot.api import expand as expand
from crowdbot.api import load as load
from crowdbot.api import results as results
from crowdbot.api import score as score
from crowdbot.api import simulate as simulate
from crowdbot.core.planning.planner import NoValidCommand as NoValidCommand
from crowdbot.core.planning.planner import Observation as Observation
from crowdbot.core.planning.planner import Planner as Planner
from crowdbot.core.planning.planner import Truth as Truth
from crowdbot.core.recording.from_mcap import Trajectories as Trajectories
from crowdbot.core.recording.recording import Recording as Recording
from crowdbot.core.results.results import Results as Results
from crowdbot.core.runs.run import Run as Run
from crowdbot.core.scoring.evaluate import Scores as Scores
from crowdbot.core.sensing.points import LidarPoints as LidarPoints
from crowdbot.core.sim.session import Session as Session
from crowdbot.core.trajectories.commands import Commands as Commands
from crowdbot.core.trajectories.questionnaires import Questionnaires as Questionnaires
from crowdbot.core.types.motion import Command as Command
from crowdbot.core.types.motion import Pose as Pose
from crowdbot.core.types.person_task import PersonEstimate as PersonEstimate
from crowdbot.core.types.person_task import PersonTask as PersonTask
from crowdbot.core.types.robot import RobotLimits as RobotLimits
from crowdbot.core.types.score import Score as Score
from crowdbot.core.types.sensor import Reading as Reading
from crowdbot.core.types.sensor import SensorInfo as SensorInfo
from crowdbot.core.types.task import Task as Task
from crowdbot.dsl.scenario.scenario import Scenario as Scenario
from crowdbot.errors import CrowdbotError as CrowdbotError
from crowdbot.errors import RecordingWarning as RecordingWarning
