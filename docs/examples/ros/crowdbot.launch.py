"""Launch crowdbot beside nodes of ROS 2 that use zenoh: ros2 launch crowdbot.launch.py.

RViz shows the frame map and the robot's model, whose wheels turn by /joint_states. Start other
nodes with RMW_IMPLEMENTATION=rmw_zenoh_cpp. Not tried with ROS 2 itself.
"""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

ARGUMENTS = {
    "suite": "challenge-2020",
    "scenario": "in-d0125-slow-c01-r02",
    "robot": "robot",
    "rate": "1",
    "router": "tcp/127.0.0.1:7447",
}
ZENOH = {"RMW_IMPLEMENTATION": "rmw_zenoh_cpp"}
RVIZ = str(Path(__file__).with_name("crowdbot.rviz"))


def generate_launch_description() -> LaunchDescription:
    """Return the simulation, in real time, the robot's frames, and a view in RViz."""
    suite, scenario, robot, rate, router = (LaunchConfiguration(name) for name in ARGUMENTS)
    serve = ["crowdbot", "serve", suite, scenario, "--rate", rate, "--epoch", "1"]
    urdf = ["crowdbot export-urdf ", robot, " --spec ", suite, " --id ", scenario]
    description = ParameterValue(Command(urdf, on_stderr="ignore"), value_type=str)
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=v) for name, v in ARGUMENTS.items()),
            ExecuteProcess(cmd=[*serve, "--zenoh", router, "--zenoh-router"], output="screen"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                additional_env=ZENOH,
                parameters=[{"use_sim_time": True, "robot_description": description}],
            ),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", RVIZ],
                additional_env=ZENOH,
                parameters=[{"use_sim_time": True}],
            ),
        ]
    )
