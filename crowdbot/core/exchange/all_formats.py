"""All formats, in the order in which files are tried."""

from __future__ import annotations

from collections.abc import Mapping

from crowdbot.core.exchange.formats import Format
from crowdbot.core.exchange.recordings import RECORDINGS
from crowdbot.core.exchange.trial.reading import TRIALS
from crowdbot.core.exchange.umans.reading import UMANS

FORMATS: Mapping[str, Format] = {form.name: form for form in (TRIALS, UMANS, RECORDINGS)}
