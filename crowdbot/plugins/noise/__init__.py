"""Noise generators of sensors."""

from crowdbot.plugins.noise.gaussian import GAUSSIAN
from crowdbot.plugins.noise.offset import OFFSET
from crowdbot.plugins.noise.peak import PEAK

COMPONENTS = (GAUSSIAN, OFFSET, PEAK)
