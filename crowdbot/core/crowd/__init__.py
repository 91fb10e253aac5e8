"""The crowd engine, usable without Drake."""

from crowdbot.core.crowd.engine import CrowdEngine, CrowdWorld
from crowdbot.core.crowd.policy import Agents, CrowdPolicy, CrowdView

__all__ = ["Agents", "CrowdEngine", "CrowdPolicy", "CrowdView", "CrowdWorld"]
