"""The crowd engine, usable without Drake."""

from crowdbot.core.crowd.agents import LOOP, PORTAL, REMOVE, STOP, Agents
from crowdbot.core.crowd.engine import CrowdEngine
from crowdbot.core.crowd.policy import (
    AcceleratingPolicy,
    CrowdPolicy,
    CrowdView,
    VelocityPolicy,
)
from crowdbot.core.crowd.words import policy_of
from crowdbot.core.crowd.world import CrowdWorld

__all__ = [
    "LOOP",
    "PORTAL",
    "REMOVE",
    "STOP",
    "AcceleratingPolicy",
    "Agents",
    "CrowdEngine",
    "CrowdPolicy",
    "CrowdView",
    "CrowdWorld",
    "VelocityPolicy",
    "policy_of",
]
