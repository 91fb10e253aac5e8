from __future__ import annotations

from crowdbot.plugin import HolonomicDrive, RobotLimits, RobotModel
from my_robots import PuckSpec

RADIUS, HEIGHT = 0.2, 0.3
FOOT = 0.03  # radius of the four balls that it slides on

URDF = """<robot name="puck">
  <link name="base_link">
    <inertial>
      <origin xyz="0 0 0.1"/><mass value="{mass}"/>
      <inertia ixx="{across}" iyy="{across}" izz="{up}" ixy="0" ixz="0" iyz="0"/>
    </inertial>
    <collision>
      <origin xyz="0 0 {middle}"/>
      <geometry><cylinder radius="{radius}" length="{length}"/></geometry>
    </collision>
    {feet}
  </link>
</robot>"""


FEET = "".join(
    f'''<collision name="foot{i}">
      <origin xyz="{x} {y} {FOOT}"/><geometry><sphere radius="{FOOT}"/></geometry>
    </collision>'''
    for i, (x, y) in enumerate([(0.15, 0.0), (0.0, 0.15), (-0.15, 0.0), (0.0, -0.15)])
)


def build(spec: PuckSpec) -> RobotModel:
    up = 0.5 * spec.mass * RADIUS**2
    across = 0.5 * up + spec.mass * HEIGHT**2 / 12.0
    return RobotModel(
        description=URDF.format(
            mass=spec.mass,
            across=across,
            up=up,
            radius=RADIUS,
            length=HEIGHT - FOOT,
            middle=0.5 * (HEIGHT + FOOT),
            feet=FEET,
        ),
        base="base_link",
        base_height=0.0,
        drive=HolonomicDrive(max_force=40.0, max_torque=4.0),
        limits=RobotLimits(v_min=-0.6, v_max=0.6, w_max=2.0, a_max=1.0, alpha_max=3.0, vy_max=0.6),
        footprint_radius=RADIUS,
        height=HEIGHT,
        force_height=0.5 * HEIGHT,
        mass=spec.mass,
    )
