"""Names of this module, and where they come from: for type checkers, and to import them."""

__all__: list[str]

from crowdbot.core.learning.build import Observer as Observer
from crowdbot.core.learning.build import Reward as Reward
from crowdbot.core.learning.seen import LearningContext as LearningContext
from crowdbot.core.learning.seen import RobotInputs as RobotInputs
from crowdbot.core.learning.seen import StepChange as StepChange
from crowdbot.core.learning.seen import sensor_named as sensor_named
