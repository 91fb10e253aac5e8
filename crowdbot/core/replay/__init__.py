"""The replay page: one offline HTML file with a run seen from above and its scores."""

from crowdbot.core.replay.page import write_replay
from crowdbot.core.replay.scan import ReplayScan

__all__ = ["ReplayScan", "write_replay"]
