"""All formats, in the order in which files are tried."""

from __future__ import annotations

from collections.abc import Mapping

from crowdbot.core.exchange.formats import SceneFormat
from crowdbot.core.exchange.others.commonroad import COMMONROAD
from crowdbot.core.exchange.others.hunav import HUNAV
from crowdbot.core.exchange.others.jupedsim import JUPEDSIM
from crowdbot.core.exchange.others.pedsim import PEDSIM
from crowdbot.core.exchange.others.robot_sf import ROBOT_SF
from crowdbot.core.exchange.others.vadere import VADERE
from crowdbot.core.exchange.recordings import RECORDINGS
from crowdbot.core.exchange.trial.reading import TRIALS
from crowdbot.core.exchange.umans.reading import UMANS

_ALL = (TRIALS, UMANS, HUNAV, PEDSIM, VADERE, JUPEDSIM, ROBOT_SF, COMMONROAD, RECORDINGS)
FORMATS: Mapping[str, SceneFormat] = {form.name: form for form in _ALL}
