"""Names of trained policies: ``FILE.onnx`` or ``sb3:FILE.zip``."""

from __future__ import annotations

from pathlib import Path

ONNX, SB3 = ".onnx", "sb3:"


def is_policy(text: str) -> bool:
    """True if a text names a trained policy."""
    return text.endswith(ONNX) or text.startswith(SB3)


def policy_file(text: str) -> Path:
    """Return the file of a policy."""
    return Path(text.removeprefix(SB3))
