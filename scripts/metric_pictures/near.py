"""Pictures of metrics of nearness, of collisions and of contacts."""

from __future__ import annotations

import numpy as np

from crowdbot.core.trajectories.encounters import encounter, robot_velocities
from crowdbot.core.trajectories.evasion import evasion
from scripts.metric_pictures.figure import BAD, PERSON, QUIET, ROBOT, Array, Figure
from scripts.metric_pictures.registry import draws
from scripts.metric_pictures.world import JUMP, World, mean_of

_ZONES = {"intimate": (0.0, 0.45), "personal": (0.45, 1.2), "social": (1.2, 3.6)}


def _gap(world: World, metric: str, high: float = 3.0) -> Figure:
    low = min(-0.1, float(world.gap.min()) - 0.05)
    return world.over_time(metric, "gap in m", low, high)


@draws("min_clearance", "The gap to the nearest person, and where it is least.")
def _min_clearance(world: World, metric: str) -> Figure:
    k = int(np.argmin(world.gap))
    figure = (
        _gap(world, metric)
        .level(0.0, "surfaces touch")
        .line(world.t, world.gap, ROBOT, "gap to the nearest person")
    )
    return figure.dots([world.t[k]], [world.gap[k]], BAD, "least")


@draws("avg_clearance", "The gap to the nearest person, and its mean over time.")
def _avg_clearance(world: World, metric: str) -> Figure:
    mean = world.scores.find(metric).value
    figure = _gap(world, metric).line(world.t, world.gap, ROBOT, "gap to the nearest person")
    return figure.level(mean or 0.0, "mean", BAD)


@draws("intimate_time_fraction", "Time with the nearest person nearer than 0.45 m.")
@draws("personal_time_fraction", "Time with the nearest person from 0.45 to 1.2 m away.")
@draws("social_time_fraction", "Time with the nearest person from 1.2 to 3.6 m away.")
def _zone(world: World, metric: str) -> Figure:
    low, high = _ZONES[metric.partition("_")[0]]
    inside = (world.gap >= low) & (world.gap < high)
    if not low:
        inside = world.gap < high
    figure = world.over_time(metric, "gap in m", min(-0.1, float(world.gap.min())), 4.0)
    figure.spans(world.t, inside, "in the zone")
    figure.line(world.t, world.gap, ROBOT, "gap to the nearest person")
    return figure.level(high, f"{high} m").level(low, f"{low} m" if low else "")


@draws("space_compliance", "Time with no person nearer than 0.5 m.")
def _space_compliance(world: World, metric: str) -> Figure:
    figure = _gap(world, metric).spans(world.t, world.gap >= 0.5, "room enough")
    return figure.line(world.t, world.gap, ROBOT, "gap to the nearest person").level(0.5, "0.5 m")


@draws("acceptance", "Gap to the nearest person, with the limits that people mind.")
def _acceptance(world: World, metric: str) -> Figure:
    figure = _gap(world, metric).spans(world.t, world.gap < 0.25, "crowding")
    figure.line(world.t, world.gap, ROBOT, "gap to the nearest person")
    return figure.level(0.25, "at any speed").level(0.5, "at speed")


@draws("proximity", "The reciprocal of the distance to the nearest person; its mean is the score.")
def _proximity(world: World, metric: str) -> Figure:
    each = 1.0 / np.maximum(world.distance, 0.1)
    return world.lines(metric, "1/distance in 1/m", [(world.t, each, ROBOT, "1/distance")])


@draws("normalized_proximity", "Distances to neighbours within 3 m: their spread over their mean.")
def _normalized_proximity(world: World, metric: str) -> Figure:
    figure = world.over_time(metric, "distance in m", 0.0, 3.6)
    mean = mean_of(np.where(world.near, world.pair.distance, np.nan))
    for j in range(0, world.pair.distance.shape[1], 3):
        there = np.where(world.near[:, j], world.pair.distance[:, j], np.nan)
        figure.line(world.t, there, QUIET, "some neighbours", wide=1.0)
    figure.line(world.t, mean, PERSON, "mean of all", wide=2.0)
    return figure.level(3.0, "neighbours are within 3 m")


@draws("neighbour_count", "How many people are within 3 m of the robot.")
def _neighbour_count(world: World, metric: str) -> Figure:
    count = world.near.sum(axis=1).astype(float)
    return world.lines(metric, "people", [(world.t, count, PERSON, "people within 3 m")])


@draws(
    "local_density", "People within 3 m of the robot, at the moment when there are most of them."
)
def _local_density(world: World, metric: str) -> Figure:
    k = int(np.argmax(world.near.sum(axis=1)))
    figure = world.bodies(world.plane(metric), k, who=lambda j: bool(world.near[k, j]))
    angle = np.linspace(0.0, 2 * np.pi, 90)
    x, y = world.robot.x[k] + 3 * np.cos(angle), world.robot.y[k] + 3 * np.sin(angle)
    return figure.line(x, y, BAD, "within 3 m", dashed=True)


@draws("intrusion", "How fast the robot drives at people, weighted by the room that they lack.")
def _intrusion(world: World, metric: str) -> Figure:
    found = evasion(world.run, 2.0, JUMP)
    gap = encounter(world.run, JUMP).gap
    room = np.nan_to_num((gap[1:] + gap[:-1]) / 2, nan=np.inf)
    lacking = np.clip(1.0 - room / 0.75, 0.0, 1.0)
    speed = (found.approach * lacking).sum(axis=1)
    middle = (world.t[1:] + world.t[:-1]) / 2
    figure = world.lines(
        metric, "speed at people in m/s", [(middle, speed, ROBOT, "approach, weighted")]
    )
    return figure.area(middle, np.zeros_like(speed), speed, "way that is counted")


def _ttc(world: World, metric: str) -> Figure:
    return world.over_time(metric, "time to collision in s", 0.0, 8.0).level(5.0, "horizon 5 s")


@draws("min_time_to_collision", "Time to the next collision if no one changed velocity; the least.")
def _min_ttc(world: World, metric: str) -> Figure:
    tau = world.time_to_collision
    k = int(np.argmin(tau))
    figure = _ttc(world, metric).line(world.t, tau, ROBOT, "time to collision")
    return figure.dots([world.t[k]], [tau[k]], BAD, "least")


@draws("time_exposed", "Time during which a collision is nearer than 5 s.")
def _time_exposed(world: World, metric: str) -> Figure:
    figure = _ttc(world, metric).spans(world.t, world.time_to_collision < 5.0, "exposed")
    return figure.line(world.t, world.time_to_collision, ROBOT, "time to collision")


@draws("integrated_time_to_collision", "The area between the time to collision and 5 s.")
def _integrated(world: World, metric: str) -> Figure:
    low = np.minimum(world.time_to_collision, 5.0)
    figure = _ttc(world, metric).area(world.t, low, np.full_like(low, 5.0), "integrated")
    return figure.line(world.t, world.time_to_collision, ROBOT, "time to collision")


def _imminence(world: World) -> Array:
    return np.maximum(0.0, 1.0 - world.time_to_collision / 5.0)


@draws("risk", "Imminence, 1 at a collision and 0 when it is 5 s away; its area is the risk.")
def _risk(world: World, metric: str) -> Figure:
    each = _imminence(world)
    figure = world.lines(
        metric, "imminence", [(world.t, each, ROBOT, "1 - time to collision / 5 s")]
    )
    return figure.area(world.t, np.zeros_like(each), each, "risk")


@draws("expected_severity", "Imminence times the squared relative speed.")
def _expected_severity(world: World, metric: str) -> Figure:
    first = np.argmin(np.nan_to_num(world.pair.gap, nan=np.inf), axis=1)
    rows = np.arange(len(world.t))
    rx, ry = robot_velocities(world.run, JUMP)
    square = (world.agents.vx[rows, first] - rx) ** 2 + (world.agents.vy[rows, first] - ry) ** 2
    each = _imminence(world) * np.nan_to_num(square)
    return world.lines(metric, "severity in m²/s²", [(world.t, each, ROBOT, "imminence × speed²")])


# ----------------------------------------------------------------------- contacts
def _onsets(world: World) -> tuple[Array, Array]:
    table = world.run.contacts
    assert table is not None
    people = table.agent >= 0
    return table.t0[people], table.t1[people]


@draws("collision_count", "The gap to the nearest person; each contact with a person is counted.")
@draws("collisions_at_fault", "Contacts, and the gap before them: who ran into whom?")
@draws("contacts_at_fault", "Contacts, and the gap before them: could the robot have braked?")
@draws("success_no_collision", "Arrival, and the contacts on the way: one is too many.")
def _contacts(world: World, metric: str) -> Figure:
    figure = _gap(world, metric, 1.5).line(world.t, world.gap, ROBOT, "gap to the nearest person")
    t0, _ = _onsets(world)
    figure.line(world.t, world.speed, QUIET, "speed of the robot, m/s", dashed=True)
    return figure.level(0.0, "surfaces touch").dots(t0, np.zeros(len(t0)), BAD, "contacts")


@draws("collision_rate", "Contacts so far over time and over the driven path.")
@draws("contacts_per_km", "Contacts so far over the progress towards the goal.")
def _rate(world: World, metric: str) -> Figure:
    t0, _ = _onsets(world)
    robot = world.robot
    far = world.to_zone(world.run)
    steps = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(robot.x), np.diff(robot.y)))])
    way = far[0] - far if metric == "contacts_per_km" else steps
    so_far = np.searchsorted(np.sort(t0), world.t, side="right").astype(float)
    name = "progress in m" if metric == "contacts_per_km" else "driven path in m"
    figure = Figure(
        world.title(metric), (name, 0.0, float(way.max())), ("contacts", 0.0, len(t0) + 0.5)
    )
    return figure.line(way, so_far, BAD, "contacts so far")


def _stems(world: World, metric: str, label: str, values: Array) -> Figure:
    t0, _ = _onsets(world)
    figure = world.over_time(metric, label, 0.0, 1.25 * float(np.max(values, initial=1e-3)))
    for at, value in zip(t0, values, strict=True):
        figure.line(np.array([at, at]), np.array([0.0, value]), BAD)
    return figure.dots(t0, values, BAD, "each contact")


@draws("collision_severity", "The relative speed just before each contact: energy grows with it.")
@draws("contact_impulse", "The impulse of each contact between robot and people.")
@draws("max_contact_force", "The peak force of each contact; the largest is the score.")
def _per_contact(world: World, metric: str) -> Figure:
    table = world.run.contacts
    assert table is not None
    label, values = {
        "collision_severity": ("relative speed in m/s", table.relative_speed),
        "contact_impulse": ("impulse in N s", table.impulse),
        "max_contact_force": ("peak force in N", table.peak_force),
    }[metric]
    return _stems(world, metric, label, values[table.agent >= 0])


@draws("contact_time", "How long each contact lasts, in the order in which they come.")
def _contact_time(world: World, metric: str) -> Figure:
    t0, t1 = _onsets(world)
    return _stems(world, metric, "duration in ms", 1000.0 * (t1 - t0))


@draws("wall_contact_count", "The gap between robot and walls; a contact would reach 0.")
@draws(
    "min_wall_clearance", "The gap between the robot and the nearest wall, and where it is least."
)
@draws("avg_wall_clearance", "The gap between the robot and the nearest wall, and its mean.")
def _wall(world: World, metric: str) -> Figure:
    gap = wall_gap(world)
    figure = world.lines(
        metric, "gap to walls in m", [(world.t, gap, ROBOT, "gap to the nearest wall")]
    )
    if metric == "min_wall_clearance":
        k = int(np.argmin(gap))
        figure.dots([world.t[k]], [gap[k]], BAD, "least")
    if metric == "avg_wall_clearance":
        figure.level(world.scores.find(metric).value or 0.0, "mean", BAD)
    return figure


def wall_gap(world: World) -> Array:
    """(N,) m between the robot's disc and the nearest wall."""
    walls, robot = world.run.walls, world.robot
    assert walls is not None
    a, d = walls[:, :2], walls[:, 2:] - walls[:, :2]
    from_a = np.column_stack([robot.x, robot.y])[:, None] - a
    along = (from_a * d).sum(-1) / np.maximum((d * d).sum(-1), 1e-12)
    off = from_a - np.clip(along, 0, 1)[..., None] * d
    return np.asarray(np.hypot(off[..., 0], off[..., 1]).min(axis=1) - robot.radius, dtype=float)
