"""Launch crowdbot beside nodes of ROS 2 that use zenoh: ros2 launch crowdbot.launch.py.

RViz shows the frame map. Start other nodes with RMW_IMPLEMENTATION=rmw_zenoh_cpp, among them
robot_state_publisher with the URDF of /robot_description. Not tried with ROS 2 itself.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = {
    "suite": "challenge-2020",
    "scenario": "in-d0125-slow-c01-r02",
    "rate": "1",
    "router": "tcp/127.0.0.1:7447",
}


def generate_launch_description() -> LaunchDescription:
    """Return the simulation, in real time, and a view in RViz."""
    suite, scenario, rate, router = (LaunchConfiguration(name) for name in ARGUMENTS)
    serve = ["crowdbot", "serve", suite, scenario, "--rate", rate, "--epoch", "1"]
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=v) for name, v in ARGUMENTS.items()),
            ExecuteProcess(cmd=[*serve, "--zenoh", router, "--zenoh-router"], output="screen"),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-f", "map"],
                additional_env={"RMW_IMPLEMENTATION": "rmw_zenoh_cpp"},
                parameters=[{"use_sim_time": True}],
            ),
        ]
    )
