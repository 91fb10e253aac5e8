"""The crowd engine, usable without Drake.

- `engine`: decisions and ticks of one crowd; `step` is one tick, compiled.
- `agents`, `world`: constant data; `parameters` is their form for compiled code.
- `state`: variable data, one flat vector; `routes`, `portals`, `periodic_boundary` change goals.
- `policy`: the interface of crowd policies; `build` builds and checks them, `desired_acceleration`
calls them, `from_spec` makes one from fields as in a scenario.
- `contact/`: forces between people, walls, pillars and robots.
- `response/`: how people respond to robots.
- `routing/`: path finding around walls.
- `velocity_search/`: policies that minimise costs over candidate velocities.
- `recorded`: trajectories of real people, from a CSV file.
"""

from crowdbot.core.crowd.agents import LOOP, PORTAL, REMOVE, STOP, Agents
from crowdbot.core.crowd.engine import CrowdEngine
from crowdbot.core.crowd.from_spec import policy_of
from crowdbot.core.crowd.policy import AcceleratingPolicy, CrowdPolicy, CrowdView, VelocityPolicy
from crowdbot.core.crowd.world import CrowdWorld

__all__ = [
    "LOOP",
    "PORTAL",
    "REMOVE",
    "STOP",
    "AcceleratingPolicy",
    "Agents",
    "CrowdEngine",
    "CrowdPolicy",
    "CrowdView",
    "CrowdWorld",
    "VelocityPolicy",
    "policy_of",
]
