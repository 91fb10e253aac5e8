"""Records with which cost functions are called.

An agent, its neighbours and walls: SI units, positions relative to the agent if stated.
"""

from __future__ import annotations

from crowdbot.core.support.records import record_type


class AgentRecord:
    """The agent whose velocity is searched.

    Attributes:
        px, py, vx, vy, radius: position, velocity, radius.
        preferred: preferred speed, > 0.
        fastest: largest speed in the search.
        time_step: time between decisions.
        gx, gy, pvx, pvy: goal; preferred velocity.
        max_speed, max_acceleration: limits.
        relaxation: the policy's relaxation time.
        weight: divisor of forces; 1 except in cases of the original, without unit.
        parity: 1 to reproduce the original's defects.
        random: state of the agent's random numbers, which functions may advance; see
            `crowdbot.core.crowd.velocity_search.minstd`.
        descends: 1 if gradients are followed.
        broken: 1 after a function has returned NaN; for internal use.
        asked_x, asked_y, asked_radius: disc with all velocities of the search.
        walls_within: largest distance of the walls that are given; 0: all in range.
        floor: address of the `FloorRecord`.
    """

    px: float
    py: float
    vx: float
    vy: float
    radius: float
    preferred: float
    fastest: float
    time_step: float
    gx: float
    gy: float
    pvx: float
    pvy: float
    max_speed: float
    max_acceleration: float
    relaxation: float
    weight: float
    parity: float
    random: float
    descends: float
    broken: float
    asked_x: float
    asked_y: float
    asked_radius: float
    walls_within: float
    floor: float


class NeighbourRecord:
    """A neighbour, in no particular order.

    Attributes:
        d2: squared distance of the centres.
        rx, ry: position relative to the agent.
        nvx, nvy: velocity.
        reach: sum of the radii.
        npx, npy: preferred velocity.
        static: 1 for a pillar, a disc that never moves.
    """

    d2: float
    rx: float
    ry: float
    nvx: float
    nvy: float
    reach: float
    npx: float
    npy: float
    static: float


class WallRecord:
    """A wall segment; outlines run counter-clockwise around solids.

    Attributes:
        ax, ay, bx, by: both ends relative to the agent.
        nx, ny: nearest point relative to the agent.
        d2: its squared distance.
    """

    ax: float
    ay: float
    bx: float
    by: float
    nx: float
    ny: float
    d2: float


class WallEnds:
    """Both ends of a wall segment of the floor, m."""

    ax: float
    ay: float
    bx: float
    by: float


class FloorRecord:
    """All walls of the floor, and cells that say which of them a person there may touch.

    Attributes:
        walls, number: address of their `WallEnds`, and how many there are.
        x0, y0, x1, y1: box around them, m.
        left, bottom, per_metre, columns, rows: as in the frame of a `SegmentGrid`.
        first, near: addresses of its other arrays.
        points_reach: reach of the `PointGrid`, m; 0 if there is none.
        points_left, points_bottom, points_per_metre, points_columns, points_rows: its frame.
        points_first, points_walls, points_first_pair, points_pairs, points_beyond: addresses of its
            other arrays.
    """

    walls: float
    number: float
    x0: float
    y0: float
    x1: float
    y1: float
    left: float
    bottom: float
    per_metre: float
    columns: float
    rows: float
    first: float
    near: float
    points_reach: float
    points_left: float
    points_bottom: float
    points_per_metre: float
    points_columns: float
    points_rows: float
    points_first: float
    points_walls: float
    points_first_pair: float
    points_pairs: float
    points_beyond: float


class CostParams:
    """Fields with which every ``params`` begins; a cost function's own record adds more.

    Attributes:
        range: range of the function, m.
        from_surface: 1 if it is measured between surfaces.
    """

    range: float
    from_surface: float


AGENT = record_type(AgentRecord)
NEIGHBOUR = record_type(NeighbourRecord)
WALL, WALL_ENDS = record_type(WallRecord), record_type(WallEnds)
FLOOR = record_type(FloorRecord)
COST_PARAMS = record_type(CostParams)
#: Number of float64 in a row of ``work``.
WORK_COLUMNS = 8
