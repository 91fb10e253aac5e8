"""Check the result of a robot's build function before it is simulated."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.robots.check_drive import beyond_the_drive
from crowdbot.core.robots.check_links import below_floor, check_masses, impossible_moments
from crowdbot.core.robots.description import Description
from crowdbot.core.robots.description_file import read_description
from crowdbot.core.robots.joint import Joint
from crowdbot.core.robots.wheel_gain import reached_speed
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.robot import DifferentialDrive, HolonomicDrive, RobotModel
from crowdbot.errors import PluginError

_LENGTH = 1e-3  # m; tolerance between two statements of a length
_AXLE = 5e-3  # m; distance of an axle from the base that is only told
_DAMPED = 0.95  # share of the largest speed; what damping takes beyond is told
_ASIDE = 0.1  # share of the track; a centre of mass that is farther from its middle is told
_FLOOR = 5e-3  # m; tolerance of a wheel's height over the floor
_SHARE = 0.01  # share of a mass or a length
_ALONG = 0.999  # cosine of the largest angle between equal directions


def check_model(model: object) -> RobotModel:
    """Return the model, with further notes, if it is a consistent robot.

    Raises:
        PluginError: it is not; the message says what to change.
    """
    if not isinstance(model, RobotModel):
        raise PluginError(f"a RobotModel is wanted, not {type(model).__name__}")
    _check_numbers(model)
    try:
        footprint_of_model(model)
    except ValueError as error:
        raise PluginError(str(error)) from error
    described = read_description(model.description)
    if "world" in described.links:
        raise PluginError("a link is called 'world', as the simulator's own: rename or remove it")
    check_masses(described)
    _check_base(model, described)
    if abs(described.mass - model.mass) > _SHARE * model.mass:
        raise PluginError(f"mass is {model.mass:g} kg; the links weigh {described.mass:g} kg")
    drive = model.drive
    notes = [*described.notes, *impossible_moments(described)]
    if isinstance(drive, DifferentialDrive):
        _check_wheels(model, drive, described)
        notes += [*_beside_axle(model, drive, described), *_damped(model, drive, described)]
        notes += _one_sided(model, drive, described)
        notes += beyond_the_drive(model, drive, described)
        notes += below_floor(described, model.base, model.base_height)
    notes = [note for note in notes if note not in model.notes]
    return replace(model, notes=(*model.notes, *notes)) if notes else model


def _beside_axle(
    model: RobotModel, drive: DifferentialDrive, described: Description
) -> Iterator[str]:
    joint = described.joint(drive.left_joint)
    x = float(described.pose(joint.child, model.base)[0, 3])
    if abs(x) > _LENGTH:
        yield (
            f"the axle is {1e3 * abs(x):.3g} mm {'ahead of' if x > 0.0 else 'behind'} "
            f"'{model.base}', about which the robot is taken to turn"
        )
    sides = (described.joint(name).child for name in (drive.left_joint, drive.right_joint))
    middle = float(np.mean([described.pose(wheel, model.base)[1, 3] for wheel in sides]))
    if abs(middle) > _AXLE:
        yield (
            f"the middle between its wheels is {1e3 * abs(middle):.3g} mm to the "
            f"{'left' if middle > 0.0 else 'right'} of '{model.base}', about which the robot is "
            "taken to turn"
        )


def _one_sided(
    model: RobotModel, drive: DifferentialDrive, described: Description
) -> Iterator[str]:
    aside = float(described.centre_of_mass(model.base)[1])
    if abs(aside) > _ASIDE * drive.track:
        light, side = (drive.left_joint, "right") if aside < 0.0 else (drive.right_joint, "left")
        yield (
            f"its centre of mass is {1e3 * abs(aside):.3g} mm to the {side} of the middle between "
            f"its wheels: '{light}' bears little weight and may slip, so that the robot turns when "
            "it speeds up (joints of a URDF robot are held at 'positions')"
        )


def _damped(model: RobotModel, drive: DifferentialDrive, described: Description) -> Iterator[str]:
    reached, most = reached_speed(model, drive, described), model.limits.v_max
    if reached < _DAMPED * most:
        yield (
            f"the damping of its joints holds the robot at {reached:.3g} m/s of v_max {most:.3g} "
            "m/s where motors turn its wheels (control: differential_drive)"
        )


def _check_numbers(model: RobotModel) -> None:
    limits, drive = model.limits, model.drive
    positive = {
        n: getattr(model, n) for n in ("footprint_radius", "height", "force_height", "mass")
    }
    positive |= {f"limits.{n}": getattr(limits, n) for n in ("a_max", "alpha_max")}
    names: Sequence[str] = ()
    if isinstance(drive, DifferentialDrive):
        names = ("command_radius", "track")
    elif isinstance(drive, HolonomicDrive):
        names = ("max_force", "max_torque", "wheel_radius", "track")
    else:
        raise PluginError(
            f"drive is a {type(drive).__name__}; a DifferentialDrive or HolonomicDrive is wanted"
        )
    positive |= {f"drive.{n}": getattr(drive, n) for n in names}
    for name, value in positive.items():
        if not (math.isfinite(value) and value > 0.0):
            raise PluginError(f"{name} is {value}; it must be positive")
    if not (math.isfinite(model.base_height) and model.base_height >= 0.0):
        raise PluginError(f"base_height is {model.base_height}; it must not be negative")
    if not (-math.inf < limits.v_min <= 0.0 <= limits.v_max < math.inf):
        raise PluginError(f"limits: 0 must be within v_min {limits.v_min} and v_max {limits.v_max}")
    if not (0.0 <= limits.w_max < math.inf and 0.0 <= limits.vy_max < math.inf):
        raise PluginError("limits: w_max and vy_max must be finite and not negative")
    if not model.skin_stiffness > 0.0:
        raise PluginError(f"skin_stiffness is {model.skin_stiffness}; it must be positive")
    if not limits.command_timeout > 0.0:
        raise PluginError(f"limits: command_timeout is {limits.command_timeout}")
    if limits.vy_max and not isinstance(drive, HolonomicDrive):
        raise PluginError("limits: vy_max is for a HolonomicDrive; two wheels do not go sideways")


def _check_base(model: RobotModel, described: Description) -> None:
    described.link(model.base)
    if "base_link" in described.links and model.base != "base_link":
        raise PluginError(
            f"base is '{model.base}'; sensors are mounted on base_link, and the robot has a link "
            "of that name: let it be the base"
        )
    pose = described.pose(model.base, described.root)
    if np.linalg.norm(pose[:2, 3]) > _LENGTH or np.trace(pose[:3, :3]) < 3.0 * _ALONG:
        raise PluginError(
            f"'{model.base}' is not straight above or below the root link '{described.root}'; "
            "the base's frame is where the robot turns"
        )


def _check_wheels(model: RobotModel, drive: DifferentialDrive, described: Description) -> None:
    left, right = drive.left_joint, drive.right_joint
    heights = [
        float(described.pose(described.joint(name).child, model.base)[2, 3])
        for name in (left, right)
    ]
    apart = abs(heights[0] - heights[1])
    if apart > _FLOOR:
        raise PluginError(
            f"the axles of '{left}' and '{right}' are {1e3 * apart:.3g} mm apart in height; the "
            "driven wheels have one radius and one axle"
        )
    track = _checked_side(model, drive, described, left, 1.0)
    track -= _checked_side(model, drive, described, right, -1.0)
    if not math.isclose(track, drive.track, rel_tol=_SHARE):
        raise PluginError(f"track is {drive.track:g} m; the wheels are {track:g} m apart")
    if left == right:
        raise PluginError(f"the left and the right wheel are the same joint, '{left}'")


def _checked_side(
    model: RobotModel, drive: DifferentialDrive, described: Description, name: str, side: float
) -> float:
    """Return y of a driven wheel in the base's frame, m; ``side`` is 1 for the left one, or -1."""
    joint = described.joint(name)
    _check_motor(joint, name, described)
    radius = described.wheel_radius(name)
    if not math.isclose(radius, drive.command_radius, rel_tol=0.1):
        raise PluginError(
            f"the wheel on '{name}' has radius {radius:g} m; command_radius is "
            f"{drive.command_radius:g} m"
        )
    pose = described.pose(joint.child, model.base)
    try:
        _check_place(name, pose, model.base, model.base_height - drive.command_radius)
    except PluginError as error:
        raise PluginError(f"{error}{_skid_steer(drive, described)}") from error
    if side * pose[1, 3] <= 0.0:
        raise PluginError(f"the wheel on '{name}' is on the other side of the robot")
    axis = pose[:3, :3] @ joint.axis
    if axis[1] < _ALONG:
        raise PluginError(
            f"joint '{name}' does not drive ahead: its axis must point to the left of "
            f"'{model.base}', and is {np.round(axis, 3).tolist()} there"
        )
    return float(pose[1, 3])


def _check_motor(joint: Joint, name: str, described: Description) -> None:
    if not joint.free:
        raise PluginError(f"joint '{name}' is {joint.kind}; a wheel's is continuous")
    if joint.effort is None or not joint.effort > 0.0:
        element = '<limit effort="…"/>' if described.format == "urdf" else "<limit><effort>…"
        raise PluginError(f"joint '{name}' has no motor: say its torque, {element}")


def _skid_steer(drive: DifferentialDrive, described: Description) -> str:
    """Return a hint for a robot with more driven wheels than two; empty for others."""
    names = [joint.name for joint in described.joints.values() if joint.free]
    if len(names) < 4 or not {drive.left_joint, drive.right_joint} <= set(names):
        return ""
    return (
        f"; with {len(names)} wheels ({', '.join(names)}) it is skid-steered: read_published puts "
        "two driven wheels into their middle, which is an approximation"
    )


def _check_place(name: str, pose: Array, base: str, fitting: float) -> None:
    """Check a wheel's position.

    ``fitting``: height of the base above the axle of a wheel on the floor.
    """
    x, _, z = pose[:3, 3].tolist()
    if abs(x) > _AXLE:
        raise PluginError(
            f"the wheel on '{name}' is {abs(x):g} m {'ahead of' if x > 0.0 else 'behind'} '{base}',"
            " whose frame must be on the drive axis' vertical, where the robot turns: "
            "read_published moves it there, or move the links"
        )
    if abs(z + fitting) > _FLOOR:
        raise PluginError(
            f"the wheel on '{name}' ends {abs(z + fitting):g} m "
            f"{'above' if z + fitting > 0.0 else 'below'} the floor: base_height and "
            "command_radius do not fit the description"
        )
