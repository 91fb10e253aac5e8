"""The hooks of crowdbot.

Each is called once, while the registry is built, before any scenario is read. Keep them cheap:
name components as text, so that a module is imported when its category is first asked for. An
exception disables the plugin that raised it, no other, and is shown by ``crowdbot plugins``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import pluggy

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

    from crowdbot.dsl.spec.component import Component

#: Version of this file. A plugin module declares ``CROWDBOT_API = 1``.
API_VERSION = 1
#: The oldest version that this crowdbot supports.
OLDEST_API = 1

hookspec = pluggy.HookspecMarker("crowdbot")
hookimpl = pluggy.HookimplMarker("crowdbot")


@hookspec
def crowdbot_components() -> Mapping[str, Sequence[Component[Any] | str]]:  # type: ignore[empty-body]
    """Return the components that this package provides, by category.

    The categories are ``environment``, ``robot``, ``sensor``, ``noise``, ``planner``,
    ``crowd policy``, ``cost function``, ``metric``, ``observation`` and ``reward``. What is listed
    may be

    - ``"package.module:NAME"``: the component of this name;
    - ``"package.folder.*"``: all components of this category whose specs are defined in the
      modules of a package and of its subpackages, those that end in ``_build`` left out;
    - a component itself.

    Text is imported when its category is first asked for: a command that reads scenarios imports
    no planner and no metric. Components are built later: see `crowdbot.plugin.BuildRobot` and its
    like.

    Returns:
        Category -> components; each ``spec.kind`` is ``"NAME.something"``, NAME being that of the
        entry point. An exception, or anything else, disables this plugin alone; a reference that
        cannot be imported takes this plugin's components of the category away.

    Example::

        @hookimpl
        def crowdbot_components():
            return {
                "robot": ["crowdbot_acme.cart:CART"],
                "metric": ["crowdbot_acme.metrics.*"],
            }
    """


@hookspec
def crowdbot_scenario_dirs() -> Sequence[Traversable]:  # type: ignore[empty-body]
    """Return folders with suites: ``office.yaml`` of the plugin ``acme`` is ``acme:office``.

    Called once, while the registry is built. Folders are searched if a document's name is not a
    path, or it extends ``NAME:...``; they may be in an archive.

    Returns:
        A list or tuple of folders. Files that only serve ``extends`` go into a subfolder.

    Example::

        @hookimpl
        def crowdbot_scenario_dirs():
            return [importlib.resources.files(__name__) / "suites"]
    """
