"""The decisions of a crowd whose people sample velocities, from its tables, compiled."""

from __future__ import annotations

from crowdbot.core.batch import crowd_tables as c
from crowdbot.core.batch.array_tables import floats1, floats2, floats3, ints1, ints2, mask1
from crowdbot.core.crowd.contact.robot_contact import R_SEEN, R_W, RVX, RVY
from crowdbot.core.crowd.response.evasion import evade_robots
from crowdbot.core.crowd.response.parameters import DECISION_RESPONSE
from crowdbot.core.crowd.state import AGENT_COLUMNS, HEADER_SIZE, PERSON, PRESENT, People
from crowdbot.core.crowd.velocity_search.approach import approach
from crowdbot.core.crowd.velocity_search.neighbours import DISC
from crowdbot.core.crowd.velocity_search.records import AGENT, NEIGHBOUR, WALL
from crowdbot.core.crowd.velocity_search.sampling import choose_velocities
from crowdbot.core.crowd.velocity_search.surroundings import SETTINGS, TRAITS, sort_surroundings
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import as_rows
from crowdbot.core.types.arrays import Array, Indices


@kernel
def decide(crowd: Indices, groups: Indices, now: float) -> bool:
    """Set the desired accelerations of all people, as `CrowdEngine` does.

    Args:
        crowd: (F, 4) entries of a `crowd_table`.
        groups: (G, F, 4) entries of its `group_tables`.
        now: time, s.

    Returns:
        True unless a cost function returned NaN.
    """
    flat, robots, seen = floats1(crowd, c.FLAT), floats2(crowd, c.ROBOTS), floats2(crowd, c.SEEN)
    count = floats1(crowd, c.RADIUS).shape[0]
    people = as_rows(flat[HEADER_SIZE : HEADER_SIZE + count * AGENT_COLUMNS], PERSON)
    look(people, crowd, robots, seen)
    sound = True
    for g in range(groups.shape[0]):
        sound = decide_group(people, crowd, groups[g], seen) and sound
    if robots.shape[0] > 0:
        evade(people, crowd, seen, now)
    return sound


@kernel
def evade(people: People, crowd: Indices, seen: Array, now: float) -> None:
    """Change desired accelerations of people who have noticed robots (R, 8), see `RobotRecord`."""
    evade_robots(
        people, floats1(crowd, c.RADIUS), mask1(crowd, c.HEEDS), mask1(crowd, c.LATE),
        floats1(crowd, c.ATTENTION), floats1(crowd, c.PREFERRED), seen,
        floats3(crowd, c.OUTLINES), as_rows(floats1(crowd, c.EVADES), DECISION_RESPONSE), now,
    )  # fmt: skip


@kernel
def look(people: People, crowd: Indices, robots: Array, seen: Array) -> None:
    """Write the input of a decision: positions, velocities and goals of people, and robots."""
    position, velocity = floats2(crowd, c.POSITION), floats2(crowd, c.VELOCITY)
    goal, present = floats2(crowd, c.GOAL), mask1(crowd, c.PRESENT)
    for i in range(people.shape[0]):
        position[i, 0], position[i, 1] = people[i].x, people[i].y
        velocity[i, 0], velocity[i, 1] = people[i].vx, people[i].vy
        goal[i, 0], goal[i, 1] = people[i].goal_x, people[i].goal_y
        present[i] = people[i].waiting == PRESENT
    moves = ints1(crowd, c.COUNTS)[c.MOTION_SEEN] != 0
    for r in range(robots.shape[0]):
        for k in range(robots.shape[1]):
            hidden = not moves and (k in (RVX, RVY, R_W))
            seen[r, k] = 0.0 if hidden else robots[r, k]


@kernel
def _begin(people: People, crowd: Indices, group: Indices, seen: Array) -> None:
    """Initialise a group's decision: who decides, which robots are seen, chosen velocities of 0."""
    present, members = mask1(crowd, c.PRESENT), mask1(group, c.G_MEMBERS)
    decides, chosen = mask1(group, c.G_DECIDES), floats2(group, c.G_CHOSEN)
    for i in range(people.shape[0]):
        decides[i] = present[i] and members[i]
        chosen[i, 0] = chosen[i, 1] = 0.0
    shown = floats2(group, c.G_SHOWN)
    for r in range(shown.shape[0]):
        for k in range(4):
            shown[r, k] = seen[r, k]
        shown[r, 4] = seen[r, R_SEEN]


@kernel
def decide_group(people: People, crowd: Indices, group: Indices, seen: Array) -> bool:
    """Set the accelerations of one group; return False if a cost function returned NaN."""
    _begin(people, crowd, group, seen)
    choices, numbers = ints1(group, c.G_CHOICES), floats1(group, c.G_NUMBERS)
    present, decides = mask1(crowd, c.PRESENT), mask1(group, c.G_DECIDES)
    shown, chosen = floats2(group, c.G_SHOWN), floats2(group, c.G_CHOSEN)
    position, velocity = floats2(crowd, c.POSITION), floats2(crowd, c.VELOCITY)
    goal, pillars = floats2(crowd, c.GOAL), floats2(crowd, c.DISCS)
    table = as_rows(floats1(group, c.G_TABLE), DISC)
    deciding = as_rows(floats1(group, c.G_DECIDING), AGENT)
    deciding[0].broken = 0.0
    reach = numbers[c.REACH]
    starts = ints2(group, c.G_STARTS)
    count, height, low, strips = sort_surroundings(
        position, velocity, goal, floats1(crowd, c.AVOIDED), floats1(crowd, c.PREFERRED), present,
        shown, pillars, floats1(group, c.G_BOX), True, reach,
        as_rows(floats1(group, c.G_DISCS), DISC), table, starts, ints2(group, c.G_ORDER),
    )  # fmt: skip
    choose_velocities(
        table[:count], starts[: strips + 1], low, height, decides, goal, floats2(crowd, c.WALLS),
        floats1(group, c.G_GRID_FRAME), ints1(group, c.G_GRID_FIRST), ints1(group, c.G_GRID_NEAR),
        reach, as_rows(floats1(group, c.G_TRAITS), TRAITS),
        as_rows(floats1(group, c.G_SETTINGS), SETTINGS), floats1(group, c.G_RANDOM),
        as_rows(floats1(group, c.G_NEAR), NEIGHBOUR), as_rows(floats1(group, c.G_FOUND), WALL),
        deciding, ints2(group, c.G_FUNCTIONS), floats1(group, c.G_WEIGHTS),
        choices[c.BASE], choices[c.DIRECTION], choices[c.SCALE], numbers[c.HALF],
        choices[c.DRAWN] != 0, choices[c.ORDERED] != 0, floats2(group, c.G_CANDIDATES),
        floats2(group, c.G_REGULAR), choices[c.TABULATED] != 0, floats3(group, c.G_RANKED),
        ints2(group, c.G_INDICES), ints1(group, c.G_FIRST), floats1(group, c.G_FRAME),
        floats2(group, c.G_WORLD), ints1(group, c.G_ACTIVE), floats2(group, c.G_TRIED), chosen,
    )  # fmt: skip
    approach(
        chosen, False, position, velocity, goal, floats1(crowd, c.RADIUS),
        floats1(crowd, c.PREFERRED), floats1(crowd, c.FASTEST_CHANGE), numbers[c.RELAXATION],
        numbers[c.STEP],
    )  # fmt: skip
    for i in range(people.shape[0]):
        if decides[i]:
            people[i].ax, people[i].ay = chosen[i, 0], chosen[i, 1]
    return bool(deciding[0].broken == 0.0)
