"""One of everything that crowdbot can be extended with."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.resources import files
from importlib.resources.abc import Traversable

from crowdbot.plugin import hookimpl

CROWDBOT_API = 1


@hookimpl
def crowdbot_components() -> Mapping[str, Sequence[str]]:
    """Return references, which are imported when their category is first asked for."""
    return {
        "environment": ["crowdbot_acme.office:OFFICE"],
        "robot": ["crowdbot_acme.cart:CART", "crowdbot_acme.glider:GLIDER"],
        "sensor": ["crowdbot_acme.radar:RADAR"],
        "noise": ["crowdbot_acme.speckle:SPECKLE"],
        "planner": ["crowdbot_acme.swerve:SWERVE", "crowdbot_acme.outside:OUTSIDE"],
        "crowd policy": ["crowdbot_acme.drift:DRIFT"],
        "cost function": [
            "crowdbot_acme.personal_space:PERSONAL_SPACE",
            "crowdbot_acme.personal_space:PERSONAL_SPACE_NUMPY",
        ],
        "metric": ["crowdbot_acme.hesitation:HESITATION"],
    }


@hookimpl
def crowdbot_scenario_dirs() -> Sequence[Traversable]:
    """Return the folder with office.yaml, found as ``acme:office``."""
    return [files(__name__) / "suites"]
