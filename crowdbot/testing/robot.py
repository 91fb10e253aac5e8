"""Checks for every robot. Those that drive it need Drake."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields
from typing import Any

import numpy as np

from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.registry.registry import Registry
from crowdbot.core.robots.check import check_model as checked
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.robot import RobotModel
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import RobotSpec
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.testing.around import around, built, specs_of
from crowdbot.testing.commanded_motion import EMPTY_FLOOR

#: Largest difference between body and footprint, m.
_OUT, _BEHIND = 0.03, 0.15
#: Largest height of parts above the declared height, m.
_HIGHER = 0.02


def check_model(component: Component[Any], registry: Registry | None = None) -> None:
    """Limits, footprint, height and mass are valid, and the drive fits the description.

    If this fails, look at `RobotModel` and `RobotLimits`: SI units; a polygon is convex and
    counter-clockwise; people push at ``force_height``, above the floor and below the top; a driven
    wheel's joint points to the left and has a torque.
    """
    for _, model in _models(component, registry):
        assert isinstance(model, RobotModel), f"build returned a {type(model).__name__}"
        limits = model.limits
        for field in fields(limits):
            value = getattr(limits, field.name)
            finite = math.isfinite(value) or field.name == "command_timeout"
            assert finite, f"{field.name} is {value}"
        assert limits.v_min <= 0.0 < limits.v_max, f"v from {limits.v_min} to {limits.v_max}"
        for name in ("w_max", "a_max", "alpha_max", "command_timeout"):
            assert getattr(limits, name) > 0.0, f"{name} is {getattr(limits, name)}"
        for name in ("footprint_radius", "height", "mass"):
            value = getattr(model, name)
            assert math.isfinite(value), f"{name} is {value}"
            assert value > 0.0, f"{name} is {value}"
        assert 0.0 < model.force_height <= model.height, f"force_height is {model.force_height}"
        if model.footprint is not None:
            _assert_footprint(model.footprint)
        checked(model)


def check_model_is_constant(component: Component[Any], registry: Registry | None = None) -> None:
    """Building the same spec twice gives the same robot.

    If this fails, the description contains the time, a local path or a random number.
    """
    pairs = zip(_models(component, registry), _models(component, registry), strict=True)
    for (_, one), (_, two) in pairs:
        for field in fields(one):
            a, b = getattr(one, field.name), getattr(two, field.name)
            assert np.array_equal(a, b), f"{field.name} differs"


def check_mass_agrees(component: Component[Any], registry: Registry | None = None) -> None:
    """The masses of the description's links sum to ``mass``.

    If this fails, add up the inertials: collisions are scored with ``mass``, the simulation uses
    the links.
    """
    for spec, model in _models(component, registry):
        rig, _ = _rig(spec, model)
        found = rig.plant.CalcTotalMass(rig.plant.CreateDefaultContext(), [rig.model])
        assert math.isclose(found, model.mass, rel_tol=0.01), (
            f"the links weigh {found:.3f} kg, mass is {model.mass:.3f} kg"
        )


def check_footprint_agrees(component: Component[Any], registry: Registry | None = None) -> None:
    """The description's collision shapes match the footprint in width and length, and the height.

    If this fails, people avoid a different shape than the robot's: compare the collision shapes
    along x and y of the base with ``footprint`` and ``footprint_radius``.
    """
    for spec, model in _models(component, registry):
        low, high, top = _extent(*_rig(spec, model))
        points = np.zeros((1, 2)) if model.footprint is None else model.footprint
        disc = model.footprint is None or len(model.footprint) == 2
        radius = model.footprint_radius if disc else 0.0
        out = np.concatenate(
            [points.min(axis=0) - radius - low, high - points.max(axis=0) - radius]
        )
        text = f"shapes reach from {low.round(3)} to {high.round(3)} m"
        assert np.all(out < _OUT), f"{text}, {out.max():.3f} m beyond the footprint"
        assert np.all(out > -_BEHIND), f"{text}, {-out.min():.3f} m less than the footprint"
        outline = footprint_of_model(model)
        inner = -float(outline.gap(np.zeros(1), np.zeros(1))[0])
        assert isinstance(spec, RobotSpec)
        assert spec.half_width <= inner + 1e-9, (
            f"half_width of the spec is {spec.half_width:.3f} m, but the outline contains a disc "
            f"of only {inner:.3f} m around the base"
        )
        assert top < model.height + _HIGHER, f"shapes are {top:.3f} m high, not {model.height} m"


def check_drives_ahead(component: Component[Any], registry: Registry | None = None) -> None:
    """The robot drives ahead along x within its limits, reproducibly and without warnings.

    If this fails, wheels turn the wrong way, slip or do not touch the floor, or the description is
    interpreted differently.
    """
    from crowdbot.testing.tiny import assert_runs, run_of, tiny_scenario

    known = around(component, registry)
    for spec in specs_of(component, known):
        scenario = tiny_scenario(known, robot=spec.model_dump(mode="json"), time_limit=2.0)
        assert_runs(scenario, known)
        robot = run_of(scenario, known).robot
        assert robot is not None
        limits = built(known, spec).limits
        due = 0.5 * min(limits.v_max, limits.a_max)
        way = float(robot.x[-1] - robot.x[0])
        assert way > due, f"{way:.2f} m ahead in 2 s, at least {due:.2f} m were expected"
        aside = float(np.max(np.abs(robot.y - robot.y[0])))
        assert aside < 0.1 * way + 0.02, f"{aside:.2f} m to the side on {way:.2f} m"
        speed = float(np.max(np.abs(robot.v)))
        assert speed < 1.1 * limits.v_max, f"{speed:.2f} m/s, v_max is {limits.v_max}"


def check_stops_without_commands(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """Without a command for ``command_timeout`` the robot brakes to a stop.

    If this fails, the robot does not follow a command that ramps to zero.
    """
    from crowdbot.testing.tiny import run_of, tiny_scenario

    known = around(component, registry)
    for spec in specs_of(component, known):
        limits = built(known, spec).limits
        braking = limits.v_max / limits.a_max
        if limits.command_timeout + braking > 0.7:  # it would still move at the next command
            continue
        words = spec.model_dump(mode="json")
        scenario = tiny_scenario(known, robot=words, rates={"planner": 1.0}, time_limit=2.0)
        robot = run_of(scenario, known).robot
        assert robot is not None
        speed = float(np.abs(robot.v[-2]))
        assert speed < 0.05, f"{speed:.2f} m/s, {limits.command_timeout} s after the last command"


def _models(
    component: Component[Any], registry: Registry | None
) -> Iterator[tuple[ComponentSpec, RobotModel]]:
    known = around(component, registry)
    for spec in specs_of(component, known):
        yield spec, built(known, spec)


def _assert_footprint(corners: Array) -> None:
    assert corners.ndim == 2, f"the footprint has shape {corners.shape}"
    assert corners.shape[1] == 2, f"the footprint has shape {corners.shape}"
    assert len(corners) >= 2, "a footprint has at least two points"
    assert np.all(np.isfinite(corners)), "the footprint is not finite"
    if len(corners) > 2:
        edges = np.roll(corners, -1, axis=0) - corners
        ahead = np.roll(edges, -1, axis=0)
        turns = edges[:, 0] * ahead[:, 1] - edges[:, 1] * ahead[:, 0]
        assert np.all(turns > 0.0), "the footprint is not convex and counter-clockwise"


def _rig(spec: ComponentSpec, model: RobotModel) -> tuple[Any, Any]:
    """Return the robot in a Drake plant on an empty floor, and Drake's inspector of its shapes."""
    from pydrake.geometry import SceneGraph
    from pydrake.systems.framework import DiagramBuilder

    from crowdbot.core.sim.control import add_robot

    modes = getattr(spec, "controls", ("differential_drive",))
    builder = DiagramBuilder()
    robot = add_robot(builder, EMPTY_FLOOR, model, next(m for m in modes if m != "kinematic"))
    (shapes,) = (x for x in builder.GetSystems() if isinstance(x, SceneGraph))
    return robot.rig, shapes.model_inspector()


def _extent(rig: Any, shapes: Any) -> tuple[Array, Array, float]:
    """Return least (2,) and largest (2,) x, y of the shapes, base frame, and their top; m."""
    plant = rig.plant
    context = plant.CreateDefaultContext()
    base = plant.GetBodyByName(rig.robot.base, rig.model).body_frame()
    found = []
    for index in plant.GetBodyIndices(rig.model):
        body = plant.get_body(index)
        link = plant.CalcRelativeTransform(context, base, body.body_frame())
        for shape in plant.GetCollisionGeometriesForBody(body):
            box = shapes.GetObbInGeometryFrame(shape)
            pose = link.multiply(shapes.GetPoseInFrame(shape)).multiply(box.pose())
            half = np.abs(pose.rotation().matrix()) @ box.half_width()
            found.append([pose.translation() - half, pose.translation() + half])
    assert found, "the description has no collision shapes"
    (low, high) = np.min(found, axis=0)[0], np.max(found, axis=0)[1]
    return low[:2], high[:2], float(high[2]) + rig.robot.base_height
