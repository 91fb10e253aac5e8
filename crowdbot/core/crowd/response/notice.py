"""Who has noticed a robot, and since when."""

from __future__ import annotations

from crowdbot.core.crowd.contact.robot_contact import R_BODY, RVX, RVY, RX, RY, extent_of, overlap
from crowdbot.core.crowd.response.parameters import (
    LATE_GAP,
    LATE_TIME,
    REACTION_TIME,
    SIGHT,
    VIEW_COSINE,
)
from crowdbot.core.crowd.state import (
    DIR_X,
    DIR_Y,
    NOTICED,
    PRESENT,
    UNAWARE,
    VX,
    VY,
    WAITING,
    X,
    Y,
)
from crowdbot.core.support.compile import kernel
from crowdbot.core.types.arrays import Array


@kernel
def reacts(
    agents: Array,
    i: int,
    radius: float,
    late: bool,
    robots: Array,
    outline: Array,
    response: Array,
    now: float,
) -> bool:
    """Whether agent i has noticed robots for long enough to do something; keeps account of it.

    Who has noticed one robot looks out for all, until none is within sight.

    Args:
        radius: of the agent, m.
        late: whether the agent notices late.
        robots, outline: as in `crowdbot.core.crowd.contact.robot_contact`.
        response: `crowdbot.core.crowd.response.parameters.Human.by_decision`.
        now: time since the start, s.
    """
    near, found, extent = False, False, extent_of(outline)
    if agents[i, WAITING] == PRESENT:
        for r in range(robots.shape[0]):
            dx, dy = robots[r, RX] - agents[i, X], robots[r, RY] - agents[i, Y]
            reach = robots[r, R_BODY] + radius
            far = response[SIGHT] + extent + reach
            if dx * dx + dy * dy > far * far:
                continue
            depth, nx, ny, _, _ = overlap(robots[r], outline, dx, dy, reach)
            if depth < -response[SIGHT]:
                continue
            near = True
            if agents[i, NOTICED] == UNAWARE and not found:
                found = _sees(agents, i, late, robots[r], -depth, nx, ny, response)
    if not near:
        agents[i, NOTICED] = UNAWARE
    elif found:
        agents[i, NOTICED] = now
    noticed = agents[i, NOTICED]
    return noticed != UNAWARE and now - noticed >= response[REACTION_TIME]


@kernel
def _sees(
    agents: Array,
    i: int,
    late: bool,
    robot: Array,
    gap: float,
    nx: float,
    ny: float,
    response: Array,
) -> bool:
    """Whether agent i notices a robot within sight, in the direction n, now."""
    if nx * agents[i, DIR_X] + ny * agents[i, DIR_Y] < response[VIEW_COSINE]:
        return False  # nobody sees what is behind
    if not late:
        return True
    closing = (agents[i, VX] - robot[RVX]) * nx + (agents[i, VY] - robot[RVY]) * ny
    return gap < response[LATE_GAP] or gap < response[LATE_TIME] * closing
