"""SDFormat text of robots built from primitives.

Wheels touch the floor with a sphere or an ellipsoid: a cylinder's contact point jumps between its
rims (docs/decisions/0004).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from crowdbot.plugins.robots.body_part import BLACK, SILVER, Colour, Part, Vector, balance


class Wheel(NamedTuple):
    """A driven wheel: m, kg, and the largest torque of its motor, N m.

    A ``slim`` wheel touches the floor with an ellipsoid of its own width; the sphere of a large
    wheel would exceed the robot's width.
    """

    radius: float
    width: float
    hub_width: float
    mass: float
    effort: float
    slim: bool = False


def model(name: str, *links: str) -> str:
    """Return the model with all links, under this name."""
    return f"""<?xml version="1.0"?>
<sdf version="1.9" xmlns:drake="http://drake.mit.edu"><model name="{name}">
  {"".join(links)}
</model></sdf>"""


def base_link(body: Sequence[Part], *shapes: str) -> str:
    """Return the floating base link: parts with mass and appearance, plus ``shapes``."""
    centre, moments = balance(list(body))
    return f"""<link name="base_link">
    <inertial><pose>{centre[0]} {centre[1]} {centre[2]} 0 0 0</pose>
      <mass>{sum(p.mass for p in body)}</mass>{inertia(*moments)}</inertial>
    {"".join(seen(p) for p in body)}
    {"".join(shapes)}
  </link>
  """


def slider(name: str, at: Vector, radius: float) -> str:
    """Return a ball that slides on the floor without friction, like a caster."""
    return collision(name, at, sphere(radius), 0.0) + visual(name, at, sphere(radius), BLACK)


def wheel(side: str, y: float, z: float, of: Wheel) -> str:
    """Return a driven wheel at (0, y, z) of base_link, m, and its joint ``SIDE_wheel_joint``."""
    across = of.mass * (3.0 * of.radius**2 + of.width**2) / 12.0
    along = 0.5 * of.mass * of.radius**2
    tyre = ellipsoid(of.radius, of.radius, 0.5 * of.width) if of.slim else sphere(of.radius)
    return f"""<link name="{side}_wheel">
    <pose relative_to="base_link">0 {y} {z} -1.5707963267948966 0 0</pose>
    <inertial><mass>{of.mass}</mass>{inertia(across, across, along)}</inertial>
    {visual("tyre", (0.0, 0.0, 0.0), cylinder(of.radius, of.width), BLACK)}
    {visual("hub", (0.0, 0.0, 0.0), cylinder(0.6 * of.radius, of.hub_width), SILVER)}
    {collision("tyre", (0.0, 0.0, 0.0), tyre, 1.0)}
  </link>
  <joint name="{side}_wheel_joint" type="continuous">
    <parent>base_link</parent><child>{side}_wheel</child>
    <axis><xyz>0 0 1</xyz><limit><effort>{of.effort}</effort></limit></axis>
  </joint>"""


def wheels(track: float, z: float, of: Wheel) -> str:
    """Return the left and the right wheel, as `wheel` does, ``track`` apart, m."""
    return wheel("left", 0.5 * track, z, of) + wheel("right", -0.5 * track, z, of)


def inertia(xx: float, yy: float, zz: float) -> str:
    """Return the principal moments of inertia, kg m^2."""
    return (
        f"<inertia><ixx>{xx}</ixx><iyy>{yy}</iyy><izz>{zz}</izz>"
        "<ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia>"
    )


def cylinder(radius: float, length: float) -> str:
    """Return a cylinder along z, m."""
    return f"<cylinder><radius>{radius}</radius><length>{length}</length></cylinder>"


def sphere(radius: float) -> str:
    """Return a sphere, m."""
    return f"<sphere><radius>{radius}</radius></sphere>"


def ellipsoid(x: float, y: float, z: float) -> str:
    """Return an ellipsoid with these radii, m."""
    return f"<ellipsoid><radii>{x} {y} {z}</radii></ellipsoid>"


def box(x: float, y: float, z: float) -> str:
    """Return a box with these sides, m."""
    return f"<box><size>{x} {y} {z}</size></box>"


def seen(part: Part) -> str:
    """Return the appearance of a part as SDFormat."""
    a, b, c = part.size
    shape = box(a, b, c) if part.shape == "box" else cylinder(a, c)
    return visual(part.name, part.at, shape, part.colour, part.pitch)


def visual(name: str, at: Vector, shape: str, colour: Colour, pitch: float = 0.0) -> str:
    """Return a visual element with this shape."""
    rgba = f"{colour[0]} {colour[1]} {colour[2]} 1"
    return (
        f'<visual name="{name}"><pose>{at[0]} {at[1]} {at[2]} 0 {pitch} 0</pose>'
        f"<geometry>{shape}</geometry><material><diffuse>{rgba}</diffuse></material></visual>"
    )


def collision(name: str, at: Vector, shape: str, friction: float) -> str:
    """Return a collision element with this shape."""
    return (
        f'<collision name="{name}"><pose>{at[0]} {at[1]} {at[2]} 0 0 0</pose>'
        f"<geometry>{shape}</geometry><drake:proximity_properties>"
        f"<drake:mu_dynamic>{friction}</drake:mu_dynamic>"
        f"<drake:mu_static>{friction}</drake:mu_static>"
        "<drake:hunt_crossley_dissipation>1.0</drake:hunt_crossley_dissipation>"
        "</drake:proximity_properties></collision>"
    )
