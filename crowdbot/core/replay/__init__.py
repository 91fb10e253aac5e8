"""The replay page: one offline HTML file with a run seen from above and its scores."""

from crowdbot.core.recording.scans import ReplayScan
from crowdbot.core.replay.other_track import OtherTrack
from crowdbot.core.replay.page import write_replay

__all__ = ["OtherTrack", "ReplayScan", "write_replay"]
