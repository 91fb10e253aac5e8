"""TurtleBot2 as SDFormat text, from primitives.

Sources: Kobuki and TurtleBot2 data sheets and descriptions (dimensions, encoder, limits); the
whole weighs 6.3 kg, of which two wheels of 0.15 kg. Wheels touch the floor with a sphere:
a cylinder's contact point jumps between its rims (docs/decisions/0004).
"""

from __future__ import annotations

from crowdbot.core.interfaces import DifferentialDrive, RobotLimits, RobotModel
from crowdbot.plugins.robots.turtlebot2 import Turtlebot2Spec

WHEEL_RADIUS = 0.0352  # physical, m; the firmware believes in 0.035
TRACK = 0.230
BODY_RADIUS = 0.178
BODY_HEIGHT = 0.42
BASE_HEIGHT = 0.0102  # base_link above the floor
CASTER_RADIUS = 0.017
CASTERS = {"front": 0.115, "rear": -0.135}
PLATES = (0.1204, 0.1772, 0.3864)  # heights of the plates' centres above base_link
COM_HEIGHT = 0.13  # above the floor
WHEEL_MASS = 0.15


def build(spec: Turtlebot2Spec) -> RobotModel:
    """The model with this spec's mass and limits."""
    return RobotModel(
        sdf=_sdf(spec.mass),
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
        force_height=COM_HEIGHT,
        mass=spec.mass,
    )


def _sdf(mass: float) -> str:
    body = mass - 2.0 * WHEEL_MASS
    across = body * (3.0 * BODY_RADIUS**2 + BODY_HEIGHT**2) / 12.0
    casters = "".join(
        _collision(
            f"{name}_caster", (x, 0.0, CASTER_RADIUS - BASE_HEIGHT), _sphere(CASTER_RADIUS), 0.0
        )
        for name, x in CASTERS.items()
    )
    plates = "".join(
        _visual(f"plate{i}", (-0.0136, 0.0, z), _cylinder(0.17, 0.006))
        for i, z in enumerate(PLATES)
    )
    middle = 0.5 * BODY_HEIGHT - BASE_HEIGHT + 0.01
    return f"""<?xml version="1.0"?>
<sdf version="1.9" xmlns:drake="http://drake.mit.edu"><model name="turtlebot2">
  <link name="base_link">
    <inertial><pose>0 0 {COM_HEIGHT - BASE_HEIGHT} 0 0 0</pose><mass>{body}</mass>
      {_inertia(across, across, 0.5 * body * BODY_RADIUS**2)}</inertial>
    {_visual("base", (0.0, 0.0, 0.0545), _cylinder(0.176, 0.09))}{plates}
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
    {_visual("wheel", (0.0, 0.0, 0.0), _cylinder(WHEEL_RADIUS, 0.0206))}
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


def _visual(name: str, at: tuple[float, float, float], shape: str) -> str:
    return (
        f'<visual name="{name}"><pose>{at[0]} {at[1]} {at[2]} 0 0 0</pose>'
        f"<geometry>{shape}</geometry></visual>"
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
