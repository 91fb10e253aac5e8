"""Who has noticed a robot, and since when."""

from __future__ import annotations

from crowdbot.core.crowd.contact.robot_contact import (
    R_BODY,
    RVX,
    RVY,
    RX,
    RY,
    corners_of,
    extent_of,
    overlap,
)
from crowdbot.core.crowd.response.parameters import (
    DECISION,
    LATE_GAP,
    LATE_TIME,
    LATE_TIME_STANDING,
    REACTION_TIME,
    SEEN_MOVING,
    SEEN_STANDING,
    SIGHT,
    VIEW_COSINE,
)
from crowdbot.core.crowd.response.standing import FAR, stands
from crowdbot.core.crowd.state import (
    BESIDE,
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

#: Nobody comes nearer to a robot faster than this, m/s.
_FASTEST = 5.0


@kernel
def reacts(
    agents: Array,
    i: int,
    radius: float,
    late: bool,
    robots: Array,
    outlines: Array,
    response: Array,
    now: float,
) -> bool:
    """Whether agent i has noticed robots for long enough to do something; keeps account of it.

    Who has noticed one robot looks out for all, until none is within sight.

    Args:
        radius: of the agent, m.
        late: whether the agent notices late.
        robots, outlines: as in `crowdbot.core.crowd.contact.robot_contact`.
        response: `crowdbot.core.crowd.response.parameters.Human.by_decision`.
        now: time since the start, s.
    """
    near, found = False, False
    agents[i, BESIDE] = 0.0
    if agents[i, WAITING] == PRESENT:
        for r in range(robots.shape[0]):
            dx, dy = robots[r, RX] - agents[i, X], robots[r, RY] - agents[i, Y]
            reach, outline = robots[r, R_BODY] + radius, outlines[r][: corners_of(outlines, r)]
            away2, around = dx * dx + dy * dy, extent_of(outline) + reach
            if away2 < (FAR + _FASTEST * response[DECISION] + around) ** 2:
                agents[i, BESIDE] = 1.0
            if away2 > (response[SIGHT] + around) ** 2:
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
    noticed: float = agents[i, NOTICED]
    return noticed != UNAWARE and now - noticed >= float(response[REACTION_TIME])


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
    share = stands(robot, 0.0, response[SEEN_STANDING], response[SEEN_MOVING])
    time = response[LATE_TIME] + share * (response[LATE_TIME_STANDING] - response[LATE_TIME])
    return gap < max(float(response[LATE_GAP]), float(time * closing))
