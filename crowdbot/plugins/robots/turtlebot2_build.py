"""TurtleBot2 as SDFormat text, from primitives.

Sources: Kobuki and TurtleBot2 data sheets and descriptions (dimensions, encoder, limits); masses
are in `crowdbot.plugins.robots.turtlebot2_parts`. Wheels touch the floor with a sphere: a
cylinder's contact point jumps between its rims (docs/decisions/0004).
"""

from __future__ import annotations

from crowdbot.core.interfaces import DifferentialDrive, RobotLimits, RobotModel
from crowdbot.plugins.robots.turtlebot2 import Turtlebot2Spec
from crowdbot.plugins.robots.turtlebot2_parts import BLACK, SILVER, Colour, Part, balance, parts

WHEEL_RADIUS = 0.0352  # physical, m; the firmware believes in 0.035
TRACK = 0.230
BODY_RADIUS = 0.178
BODY_HEIGHT = 0.42
BASE_HEIGHT = 0.0102  # base_link above the floor
CASTER_RADIUS = 0.017
CASTERS = {"front": 0.115, "rear": -0.135}
WHEEL_MASS = 0.15


def build(spec: Turtlebot2Spec) -> RobotModel:
    """The model with this spec's mass and limits; people push at the height of its centre."""
    body = spec.mass - 2.0 * WHEEL_MASS
    (_, _, z), _ = balance(parts(body))
    centre = (body * (z + BASE_HEIGHT) + 2.0 * WHEEL_MASS * WHEEL_RADIUS) / spec.mass
    return RobotModel(
        description=_sdf(spec.mass),
        base="base_link",
        base_height=BASE_HEIGHT,
        drive=DifferentialDrive(
            left_joint="left_wheel_joint",
            right_joint="right_wheel_joint",
            command_radius=WHEEL_RADIUS,
            track=TRACK,
        ),
        limits=RobotLimits(
            v_min=-spec.max_speed,
            v_max=spec.max_speed,
            w_max=spec.max_yaw_rate,
            a_max=spec.max_acceleration,
            alpha_max=spec.max_yaw_acceleration,
            command_timeout=spec.command_timeout,
        ),
        footprint_radius=BODY_RADIUS,
        height=BODY_HEIGHT,
        force_height=centre,
        mass=spec.mass,
    )


def _sdf(mass: float) -> str:
    body = parts(mass - 2.0 * WHEEL_MASS)
    centre, moments = balance(body)
    casters = "".join(
        _collision(
            f"{name}_caster", (x, 0.0, CASTER_RADIUS - BASE_HEIGHT), _sphere(CASTER_RADIUS), 0.0
        )
        + _visual(
            f"{name}_caster", (x, 0.0, CASTER_RADIUS - BASE_HEIGHT), _sphere(CASTER_RADIUS), BLACK
        )
        for name, x in CASTERS.items()
    )
    middle = 0.5 * BODY_HEIGHT - BASE_HEIGHT + 0.01
    return f"""<?xml version="1.0"?>
<sdf version="1.9" xmlns:drake="http://drake.mit.edu"><model name="turtlebot2">
  <link name="base_link">
    <inertial><pose>{centre[0]} {centre[1]} {centre[2]} 0 0 0</pose>
      <mass>{sum(p.mass for p in body)}</mass>{_inertia(*moments)}</inertial>
    {"".join(_part(p) for p in body)}
    {_collision("body", (0.0, 0.0, middle), _cylinder(BODY_RADIUS, BODY_HEIGHT - 0.04), 0.3)}
    {casters}
  </link>
  {_wheel("left", 0.5 * TRACK)}{_wheel("right", -0.5 * TRACK)}
</model></sdf>"""


def _wheel(side: str, y: float) -> str:
    across = WHEEL_MASS * (3.0 * WHEEL_RADIUS**2 + 0.0206**2) / 12.0
    along = 0.5 * WHEEL_MASS * WHEEL_RADIUS**2
    return f"""<link name="{side}_wheel">
    <pose relative_to="base_link">0 {y} {WHEEL_RADIUS - BASE_HEIGHT} -1.5707963267948966 0 0</pose>
    <inertial><mass>{WHEEL_MASS}</mass>{_inertia(across, across, along)}</inertial>
    {_visual("tyre", (0.0, 0.0, 0.0), _cylinder(WHEEL_RADIUS, 0.0206), BLACK)}
    {_visual("hub", (0.0, 0.0, 0.0), _cylinder(0.6 * WHEEL_RADIUS, 0.022), SILVER)}
    {_collision("tyre", (0.0, 0.0, 0.0), _sphere(WHEEL_RADIUS), 1.0)}
  </link>
  <joint name="{side}_wheel_joint" type="continuous">
    <parent>base_link</parent><child>{side}_wheel</child>
    <axis><xyz>0 0 1</xyz><limit><effort>1.0</effort></limit></axis>
  </joint>"""


def _inertia(xx: float, yy: float, zz: float) -> str:
    return (
        f"<inertia><ixx>{xx}</ixx><iyy>{yy}</iyy><izz>{zz}</izz>"
        "<ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia>"
    )


def _cylinder(radius: float, length: float) -> str:
    return f"<cylinder><radius>{radius}</radius><length>{length}</length></cylinder>"


def _sphere(radius: float) -> str:
    return f"<sphere><radius>{radius}</radius></sphere>"


def _part(part: Part) -> str:
    a, b, c = part.size
    shape = f"<box><size>{a} {b} {c}</size></box>" if part.shape == "box" else _cylinder(a, c)
    return _visual(part.name, part.at, shape, part.colour, part.pitch)


def _visual(
    name: str, at: tuple[float, float, float], shape: str, colour: Colour, pitch: float = 0.0
) -> str:
    rgba = f"{colour[0]} {colour[1]} {colour[2]} 1"
    return (
        f'<visual name="{name}"><pose>{at[0]} {at[1]} {at[2]} 0 {pitch} 0</pose>'
        f"<geometry>{shape}</geometry><material><diffuse>{rgba}</diffuse></material></visual>"
    )


def _collision(name: str, at: tuple[float, float, float], shape: str, friction: float) -> str:
    return (
        f'<collision name="{name}"><pose>{at[0]} {at[1]} {at[2]} 0 0 0</pose>'
        f"<geometry>{shape}</geometry><drake:proximity_properties>"
        f"<drake:mu_dynamic>{friction}</drake:mu_dynamic>"
        f"<drake:mu_static>{friction}</drake:mu_static>"
        "<drake:hunt_crossley_dissipation>1.0</drake:hunt_crossley_dissipation>"
        "</drake:proximity_properties></collision>"
    )
