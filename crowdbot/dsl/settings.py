"""Settings as ``key=value`` texts, whatever they were given as."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from crowdbot.errors import InputError


def setting_texts(settings: str | Sequence[str] | Mapping[str, object]) -> Sequence[str]:
    """Settings as ``key=value`` texts.

    Args:
        settings: one text, several, or a mapping of keys to values that JSON can say.

    Raises:
        InputError: a value cannot be written as JSON.
    """
    if not isinstance(settings, Mapping):
        return [settings] if isinstance(settings, str) else settings
    try:
        return [f"{key}={json.dumps(value)}" for key, value in settings.items()]
    except (TypeError, ValueError) as error:
        raise InputError(f"a setting is a number, text, list or mapping: {error}") from None
