"""The checks of ``crowdbot doctor``."""

from __future__ import annotations

import ctypes
import importlib
import os
import platform
import re
import shutil
import tempfile
import time
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from typing import Literal, NamedTuple

from crowdbot.errors import CrowdbotError

#: Required packages.
_NEEDED = ("crowdbot", "drake", "numba", "numpy", "mcap", "pydantic", "rosbags", "scipy")
#: Approximate size of a campaign of 162 scenarios and three seeds, bytes.
_DISK = 2 * 10**9


class DoctorFinding(NamedTuple):
    """One finding: ``ok``, ``note`` (a feature is unavailable) or ``missing``."""

    what: str
    verdict: Literal["ok", "note", "missing"]
    found: str


def machine(out: Path) -> Iterator[DoctorFinding]:
    """Yield all checks except the self-test; quick.

    Args:
        out: folder for runs.
    """
    yield DoctorFinding(
        "system", "ok", f"{platform.platform()}, Python {platform.python_version()}"
    )
    yield from _packages()
    yield _drake()
    yield _egl()
    yield _kernels()
    yield _containment()
    yield _cores()
    yield _disk(out)


def _packages() -> Iterator[DoctorFinding]:
    for name in _NEEDED:
        found = _version(name)
        yield DoctorFinding(name, "ok" if found else "missing", found or "not installed")
    for name, extra in _extras().items():
        found = _version(name)
        hint = f"not installed; pip install 'crowdbot[{extra}]' brings it"
        yield DoctorFinding(name, "ok" if found else "note", found or hint)


def _extras() -> dict[str, str]:
    """Return optional distribution -> the extra that installs it."""
    extras = dict[str, str]()
    for text in requires("crowdbot") or ():
        extra = re.search(r"extra == ['\"]([\w-]+)", text)
        name = re.match(r"[\w.-]+", text)
        if extra and name:
            extras.setdefault(name[0], extra[1])
    return extras


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return ""


def _drake() -> DoctorFinding:
    try:
        importlib.import_module("crowdbot.core.sim.simulate")
    except ImportError as error:
        return DoctorFinding("Drake", "missing", f"cannot be imported: {error}")
    return DoctorFinding("Drake", "ok", "can be imported")


def _egl() -> DoctorFinding:
    """Check for EGL, which only cameras' colour images require."""
    for name in ("libEGL.so.1", "libEGL.so"):
        try:
            ctypes.CDLL(name)
        except OSError:
            continue
        return DoctorFinding("EGL", "ok", name)
    return DoctorFinding("EGL", "note", "no libEGL: cameras have depth, but no colour images")


def _kernels() -> DoctorFinding:
    from crowdbot.core.support.compile_cache import kernel_folder, nothing_compiled

    folder = os.environ.get("NUMBA_CACHE_DIR") or str(kernel_folder())
    if nothing_compiled():
        return DoctorFinding(
            "kernels", "note", f"not compiled yet: the first run does it, in {folder}"
        )
    return DoctorFinding("kernels", "ok", f"compiled, in {folder}")


def _containment() -> DoctorFinding:
    from crowdbot.core.planning.containment.offer import kernel_offer

    if missing := kernel_offer().missing:
        return DoctorFinding("containment", "note", f"planners are not contained: {missing}")
    return DoctorFinding("containment", "ok", "files, network, signals, processes of planners")


def _cores() -> DoctorFinding:
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return DoctorFinding(
        "cores", "ok", f"{usable} usable; a campaign runs as many scenarios at a time"
    )


def _disk(out: Path) -> DoctorFinding:
    folder = next(p for p in (out.absolute(), *out.absolute().parents) if p.is_dir())
    free = shutil.disk_usage(folder).free
    text = f"{free / 1e9:.1f} GB free at {folder}"
    if not os.access(folder, os.W_OK):
        return DoctorFinding("disk", "missing", f"{folder} cannot be written")
    return DoctorFinding("disk", "ok" if free > _DISK else "note", text)


def self_test() -> DoctorFinding:
    """Simulate, record and score one second among people, in a temporary folder."""
    import crowdbot.api as api

    begin = time.perf_counter()
    try:
        scenario = api.load(
            "challenge-2020",
            "counter-d0250-dispersed-c20-r05",
            set="robots.robot.task.time_limit=1",
        )
        with tempfile.TemporaryDirectory(prefix="crowdbot-") as folder:
            run = api.simulate(scenario, planner="dwa", out=folder)
            good = run.status == "timeout" and len(api.evaluate(run, "speed")) > 0
    except (CrowdbotError, ImportError) as error:
        return DoctorFinding("self-test", "missing", f"failed: {error}")
    seconds = time.perf_counter() - begin
    text = f"simulated, recorded and scored in {seconds:.1f} s"
    return DoctorFinding("self-test", "ok" if good else "missing", text)
