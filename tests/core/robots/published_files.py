"""Two URDF files of our own, with the structure of those that are published for Pepper and Qolo.

Pepper's (ros-naoqi/pepper_robot) has its base_link in the torso, 0.82 m up, its base_footprint
below the shins, 0 0 0 for axes of fixed joints, fingers of 2 mg that mimic the hands, collision
meshes of another package, Gazebo's plugins, and a transmission for each motor. Qolo's
(hubernikus/qolo_fast_modulation) calls its base tf_qolo, has fixed wheels whose names are
exchanged, and inertias of wheels that are a hundred times too large.
"""

from __future__ import annotations

MESH = '<geometry><mesh filename="package://{}" scale="0.1 0.1 0.1"/></geometry>'
SENSORS = ("CameraTop", "CameraBottom", "CameraDepth", "SonarFront", "SonarBack", "Tablet",
           "BumperFL", "BumperFR", "BumperB", "SurroundingFrontLaser", "ShovelLaser",
           "Accelerometer", "Gyrometer", "HeadTouchFront", "HeadTouchMiddle", "HeadTouchRear",
           "LSpeaker", "RSpeaker", "ChestButton")  # fmt: skip
#: Parent, child, place, axis, limits of the joints that have a motor.
MOTORS = {
    "HeadYaw": ("torso", "Neck", "-0.04 0 0.17", "0 0 1.0", (-2.1, 2.1), 0.3),
    "HeadPitch": ("Neck", "Head", "0 0 0", "0 1.0 0", (-0.7, 0.6), 1.5),
    "HipRoll": ("torso", "Hip", "0 0 -0.139", "1.0 0 0", (-0.5, 0.5), 1.0),
    "HipPitch": ("Hip", "Pelvis", "0 0 -0.079", "0 1.0 0", (-1.0, 1.0), 2.5),
    "KneePitch": ("Pelvis", "Tibia", "0 0 -0.268", "0 1.0 0", (-0.5, 0.5), 11.6),
}
for side, y in (("L", 0.15), ("R", -0.15)):
    MOTORS |= {
        f"{side}ShoulderPitch": ("torso", f"{side}Shoulder", f"-0.06 {y} 0.09", "0 1.0 0",
                                 (-2.1, 2.1), 0.3),
        f"{side}ShoulderRoll": (f"{side}Shoulder", f"{side}Bicep", "0 0 0", "0 0 1.0",
                                (0.01, 1.56), 0.5),
        f"{side}ElbowRoll": (f"{side}Bicep", f"{side}ForeArm", "0.18 0 0", "0 0 1.0",
                             (-1.56, -0.01), 0.4),
        f"{side}WristYaw": (f"{side}ForeArm", f"{side}_wrist", "0.15 0 0", "1.0 0 0",
                            (-1.8, 1.8), 0.3),
        f"{side}Hand": (f"{side}_wrist", f"{side}_gripper", "0.02 0 0", "1.0 0 0",
                        (0.02, 0.98), 2e-6),
    }  # fmt: skip
WHEELS = {"WheelFL": (0.09, 0.155, 1.0752), "WheelFR": (0.09, -0.155, -1.0752),
          "WheelB": (-0.17, 0.0, 3.14159)}  # fmt: skip


def _link(name: str, mass: float, mesh: str = "pepper_meshes/{}.stl", moment: float = 0.0) -> str:
    m = moment or 0.01 * mass
    shape = MESH.format(mesh.format(name))
    return (
        f'<link name="{name}"><inertial><mass value="{mass}"/><inertia ixx="{m}" iyy="{m}" '
        f'izz="{m}" ixy="0" ixz="0" iyz="0"/></inertial><visual>{shape}</visual>'
        f"<collision>{shape}</collision></link>"
    )


def _joint(name: str, kind: str, parent: str, child: str, xyz: str, rest: str) -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}" rpy="0 0 0"/>{rest}</joint>'
    )


def pepper() -> str:
    """71 links, as many as matter of the published 80 or so."""
    parts = ['<link name="base_link"/><link name="base_footprint"/>', _link("torso", 4.0)]
    still = '<axis xyz="0 0 0"/>'
    parts.append(_joint("base_link_fixedjoint", "floating", "base_link", "torso", "0 0 0", still))
    parts.append(
        _joint("base_footprint_joint", "fixed", "Tibia", "base_footprint", "0 0 -0.334", "")
    )
    for name, (parent, child, xyz, axis, (low, high), mass) in MOTORS.items():
        limit = f'<axis xyz="{axis}"/><limit lower="{low}" upper="{high}" effort="3" velocity="5"/>'
        parts += [_link(child, mass), _joint(name, "revolute", parent, child, xyz, limit)]
        parts.append(
            f'<transmission name="{name}_Transmission"><joint name="{name}"/></transmission>'
        )
    for name, (x, y, yaw) in WHEELS.items():
        turn = '<axis xyz="1.0 0 0"/><limit effort="3.25" velocity="6.28"/>'
        text = _joint(name, "continuous", "Tibia", f"{name}_link", f"{x} {y} -0.264", turn)
        parts += [_link(f"{name}_link", 1.6), text.replace('rpy="0 0 0"', f'rpy="0 0 {yaw}"')]
    for side in "LR":
        for k in range(1, 5):
            for part in range(1, 4):
                name = f"{side}Finger{k}{part}"
                parent = f"{side}_wrist" if part == 1 else f"{side}Finger{k}{part - 1}_link"
                mimic = f'<axis xyz="0 0 1.0"/><mimic joint="{side}Hand" multiplier="0.87"/>'
                parts.append(_link(f"{name}_link", 2e-6, moment=1.1e-9))
                at = "0.02 0 0"
                parts.append(_joint(name, "continuous", parent, f"{name}_link", at, mimic))
    for name in SENSORS:
        parts.append(f'<link name="{name}_frame"/>')
        parts.append(_joint(f"Sensor/{name}_fixedjoint", "fixed", "Tibia", f"{name}_frame",
                            "0.05 0 0.1", still))  # fmt: skip
    parts.append('<gazebo reference="Head"><sensor name="camera" type="camera"/></gazebo>')
    parts.append('<gazebo><plugin name="mover" filename="libgazebo_ros_planar_move.so"/></gazebo>')
    space = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    return f'<?xml version="1.0" ?><robot name="JulietteY20MP" {space}>{"".join(parts)}</robot>'


def qolo(mesh: str = "qolo/stl/{}.stl") -> str:
    """Two fixed wheels and a bumper on a base."""
    body = _link("tf_qolo", 50.0, mesh, 15.0).replace(
        "<inertial>", '<inertial><origin xyz="-0.16 0 0.18" rpy="0 0 0"/>'
    )
    parts = [body, _link("bumper", 1.5, mesh)]
    parts.append(_joint("to_bumper", "fixed", "tf_qolo", "bumper", "0.035 0 0.015", ""))
    for side, y in (("right", 0.27), ("left", -0.27)):  # exchanged, as they are there
        name, turn = f"wheel_{side}", '<axis xyz="0 1 0"/>'
        parts.append(_link(name, 1.5, mesh, moment=5.0))
        parts.append(_joint(f"to_{name}", "fixed", "tf_qolo", name, f"0 {y} 0", turn))
    return f'<robot name="qolo"><material name="gray"/>{"".join(parts)}</robot>'
