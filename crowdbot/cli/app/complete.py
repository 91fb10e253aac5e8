"""Shell completion of suites, scenarios, planners and metrics.

Names of kinds and ids of suites are kept in the user's cache, so that pressing the tab key loads
no component and validates nothing. A change of the installed packages or of a suite's file renews
them.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

_CACHE = "completion"

#: Parameter of a command -> its category of names.
OFFERS = {
    "spec": "suites",
    "suites": "suites",
    "suite": "suites",
    "scenario": "scenarios",
    "id_": "scenarios",
    "planner": "planners",
    "planners": "planners",
    "metric": "metrics",
    "metrics": "metrics",
}


def offer(name: str) -> Callable[[Any, Any, str], list[str]] | None:
    """Return completions for a parameter of this name; None: the shell's own completion."""
    category = OFFERS.get(name)
    if category is None:
        return None

    def complete(ctx: Any, param: Any, incomplete: str) -> list[str]:
        del param
        try:
            names = _scenarios(ctx) if category == "scenarios" else _kinds()[category]
        except Exception:  # completion must never print a traceback
            return []
        return [n for n in names if n.startswith(incomplete)]

    return complete


def _scenarios(ctx: Any) -> list[str]:
    """Return the ids of the suite named earlier on the command line."""
    spec = ctx.params.get("spec") or ctx.params.get("suite") or ""
    return [] if not spec else suite_ids(str(spec))


def suite_ids(spec: str) -> list[str]:
    """Return the ids of all scenarios of a file or packaged suite."""
    path = Path(spec)
    if path.suffix in (".yaml", ".yml"):
        about = path.stat()
        key = f"{path.resolve()} {about.st_mtime_ns} {about.st_size}"
        return list(_kept("ids", key, lambda: _expanded(spec)))
    lock = _packaged_folder() / f"{spec}.lock.json"
    if lock.is_file():
        return list(json.loads(lock.read_text(encoding="utf-8"))["scenarios"])
    return list(_kept("ids", f"{spec} {_state()}", lambda: _expanded(spec)))


def _packaged_folder() -> Path:
    package = Path(__file__).parent.parent.parent
    inside = package / "scenario_specs"
    return inside if inside.is_dir() else package.parent / "scenario_specs"


def _expanded(spec: str) -> list[str]:
    from crowdbot.core.registry.registry import discover
    from crowdbot.core.scenarios.library import open_spec

    return [s.id for s in open_spec(spec, discover()).scenarios]


def _kinds() -> dict[str, list[str]]:
    """Return the names of planners, metrics and packaged suites."""
    kept: dict[str, list[str]] = _kept("kinds", _state(), _discovered)
    return kept


def _discovered() -> dict[str, list[str]]:
    from crowdbot.core.registry.registry import discover
    from crowdbot.core.scenarios.library import suite_names

    registry = discover()
    return {
        "planners": sorted(registry.components("planner")),
        "metrics": sorted(registry.components("metric")),
        "suites": suite_names(registry),
    }


def _state() -> str:
    """Return a cache key that changes when packages or crowdbot's own components change."""
    places = [Path(p) for p in sys.path if p.endswith(("site-packages", "dist-packages"))]
    own = Path(__file__).parent.parent.parent / "plugins"
    newest = max(own.rglob("*.py"), key=lambda p: p.stat().st_mtime_ns)
    places += [newest, *(p for p in own.rglob("*") if p.is_dir()), _packaged_folder()]
    allowed = os.environ.get("CROWDBOT_PLUGINS", "")
    return " ".join([allowed, *(f"{p} {p.stat().st_mtime_ns}" for p in places if p.exists())])


def _kept(prefix: str, key: str, make: Callable[[], Any]) -> Any:
    """Return the result of ``make``, cached in the user's cache folder by prefix and key."""
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "crowdbot" / _CACHE
    file = base / f"{prefix}-{hashlib.sha256(key.encode()).hexdigest()[:16]}.json"
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        made = make()
    try:
        base.mkdir(parents=True, exist_ok=True)
        part = file.with_suffix(f".{os.getpid()}")
        part.write_text(json.dumps(made), encoding="utf-8")
        part.replace(file)
    except OSError:
        pass  # without a writable home, completion is only slower
    return made
