"""Places."""

from crowdbot.plugins.environments.corridor import CORRIDOR
from crowdbot.plugins.environments.crossing_corridor import CROSSING_CORRIDOR
from crowdbot.plugins.environments.doorways import BOTTLENECK, DOORWAY
from crowdbot.plugins.environments.floor import FLOOR
from crowdbot.plugins.environments.floor_plan import FLOOR_PLAN
from crowdbot.plugins.environments.halls import PLAZA, SHED
from crowdbot.plugins.environments.junctions import CORNER, T_JUNCTION
from crowdbot.plugins.environments.street import STREET

COMPONENTS = (
    CORRIDOR,
    FLOOR,
    CROSSING_CORRIDOR,
    CORNER,
    T_JUNCTION,
    DOORWAY,
    BOTTLENECK,
    SHED,
    STREET,
    PLAZA,
    FLOOR_PLAN,
)
