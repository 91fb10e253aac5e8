"""The module that plugins import: specs and components, interfaces, value types and tools.

Specs and components describe documents; they need no numpy, and a module of specs imports nothing
else. Build functions use numpy: SI units, float64, read-only inputs, new outputs; world frame x
along the corridor, y left, z up, yaw counter-clockwise (REP-103). docs/developers/author_surface.md
describes each name. Names are imported on first use; core does not import this module.
"""

from __future__ import annotations

from crowdbot.lazy import lazy_face

__all__, __getattr__, __dir__ = lazy_face(__name__, __file__)
