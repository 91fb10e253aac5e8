"""Recordings: MCAP files of ROS 2 messages, and the state bit by bit beside them."""

from crowdbot.core.recording.header import AgentsHeader, RecordingHeader, RobotHeader
from crowdbot.core.recording.reading.commands import read_commands
from crowdbot.core.recording.reading.people_of_fleet import FleetMember, fleet_names, read_fleet
from crowdbot.core.recording.reading.recording import (
    RecordingInfo,
    WholeRecording,
    holds_run,
    read_cones,
    read_run,
    read_scans,
    read_trajectories,
    read_whole,
    recording_info,
)
from crowdbot.core.recording.writer import RecordingWriter

__all__ = [
    "AgentsHeader",
    "FleetMember",
    "RecordingHeader",
    "RecordingInfo",
    "RecordingWriter",
    "RobotHeader",
    "WholeRecording",
    "fleet_names",
    "holds_run",
    "read_commands",
    "read_cones",
    "read_fleet",
    "read_run",
    "read_scans",
    "read_trajectories",
    "read_whole",
    "recording_info",
]
