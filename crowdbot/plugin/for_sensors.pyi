"""Names of this module, and where they come from: for type checkers, and to import them."""

__all__: list[str]

from crowdbot.core.sensing.body_model import BOTTOM as BOTTOM
from crowdbot.core.sensing.body_model import RADIUS as RADIUS
from crowdbot.core.sensing.body_model import TOP as TOP
from crowdbot.core.sensing.body_model import X as X
from crowdbot.core.sensing.body_model import Y as Y
from crowdbot.core.sensing.body_model import trunk_radius as trunk_radius
from crowdbot.core.sensing.depth_mm import depth_mm as depth_mm
from crowdbot.core.sensing.depth_renderer import MOST_MILLIMETRES as MOST_MILLIMETRES
from crowdbot.core.sensing.depth_renderer import DepthRenderer as DepthRenderer
from crowdbot.core.sensing.ray_grid import FAR as FAR
from crowdbot.core.sensing.ray_grid import HIGH as HIGH
from crowdbot.core.sensing.ray_grid import LOW as LOW
from crowdbot.core.sensing.ray_grid import NEAR as NEAR
from crowdbot.core.sensing.ray_grid import GridArrays as GridArrays
from crowdbot.core.sensing.ray_grid import Obstacles as Obstacles
from crowdbot.core.sensing.ray_grid import RayGrid as RayGrid
from crowdbot.core.sensing.raycast_columns import fill_columns as fill_columns
from crowdbot.core.sensing.raycast_columns import heights_of as heights_of
from crowdbot.core.sensing.raycast_columns import meet as meet
from crowdbot.core.sensing.raycast_tilted import NO_RAYS as NO_RAYS
from crowdbot.core.sensing.raycast_tilted import grid_rays as grid_rays
