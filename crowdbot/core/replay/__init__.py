"""The replay page: one offline HTML file with runs seen from above and their scores."""

from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.replay.other_track import OtherTrack
from crowdbot.core.replay.page import write_replay
from crowdbot.core.replay.shown_run import Scenery, ShownRun

__all__ = ["OtherTrack", "ReplayScan", "Scenery", "ShownRun", "write_replay"]
