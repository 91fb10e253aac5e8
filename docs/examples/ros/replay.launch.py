"""Play a run in RViz, with the robot's model: ros2 launch replay.launch.py bag:=BAG.

BAG is the folder that ``crowdbot export RUN_DIR --to rosbag2 --out BAG`` wrote. Wheels turn if the
run was recorded with ``all``; other joints stand at zero. Not tried with ROS 2 itself.
"""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

RVIZ = str(Path(__file__).with_name("crowdbot.rviz"))


def generate_launch_description() -> LaunchDescription:
    """Return the bag, the robot's joints and frames, and a view in RViz."""
    bag, robot = LaunchConfiguration("bag"), LaunchConfiguration("robot")
    urdf = ["crowdbot export-urdf ", robot, " --spec ", bag, "/scenario.yaml"]
    description = ParameterValue(Command(urdf, on_stderr="ignore"), value_type=str)
    model = {"use_sim_time": True, "robot_description": description}
    recorded = ["--remap", "/joint_states:=/wheel_states"]
    return LaunchDescription(
        [
            DeclareLaunchArgument("bag"),
            DeclareLaunchArgument("robot", default_value="robot"),
            ExecuteProcess(cmd=["ros2", "bag", "play", bag, *recorded], output="screen"),
            Node(
                package="joint_state_publisher",
                executable="joint_state_publisher",
                parameters=[{**model, "source_list": ["/wheel_states"]}],
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[model],
            ),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", RVIZ],
                parameters=[{"use_sim_time": True}],
            ),
        ]
    )
