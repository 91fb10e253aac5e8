from __future__ import annotations

from importlib.resources import files

from crowdbot.plugin import RobotLimits, RobotModel, read_description
from my_robots import TrolleySpec


def build(spec: TrolleySpec) -> RobotModel:
    described = read_description(files("my_robots") / "trolley.urdf")
    drive = described.differential_drive("left_wheel_joint", "right_wheel_joint")
    return RobotModel(
        description=described.text,
        base="base_link",
        base_height=described.base_height(drive),
        drive=drive,
        limits=RobotLimits(v_min=-0.3, v_max=spec.max_speed, w_max=2.0, a_max=1.0, alpha_max=3.0),
        footprint_radius=0.25,
        height=0.9,
        force_height=0.25,
        mass=described.mass,
    )
