"""Convert settings of any form to ``key=value`` texts."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from crowdbot.errors import InputError, kind_of


def setting_texts(settings: str | Sequence[str] | Mapping[str, object]) -> Sequence[str]:
    """Return settings as ``key=value`` texts.

    Args:
        settings: one text, several, or a mapping of keys to JSON values.

    Raises:
        InputError: it has another type, or a value cannot be written as JSON.
    """
    if not isinstance(settings, Mapping):
        return _texts(settings)
    try:
        return [f"{key}={json.dumps(value)}" for key, value in settings.items()]
    except (TypeError, ValueError) as error:
        raise InputError(f"a setting is a number, text, list or mapping: {error}") from None


def _texts(settings: str | Sequence[str]) -> Sequence[str]:
    if isinstance(settings, str):
        return [settings]
    texts = settings if isinstance(settings, Sequence) else [settings]
    for text in texts:
        if not isinstance(text, str):
            raise InputError(f"settings are key=value texts or a mapping, not {kind_of(text)}")
    return texts
