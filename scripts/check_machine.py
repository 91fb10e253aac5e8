"""Says in one line what a machine lacks. Runs on any Python 3, before anything is installed."""

import ctypes
import importlib.util
import platform
import sys

#: Versions of Python on which CI runs the commands, each with the packages of the lock.
TRIED = ((3, 11), (3, 12), (3, 13))


def tried():
    # type: () -> str
    """Return on what crowdbot was tried, and what this machine has."""
    versions = ", ".join("{}.{}".format(*version) for version in TRIED)
    here = "{}.{}".format(*sys.version_info[:2])
    text = "tried on Linux x86-64 with Python {}; this is {} {} with Python {}".format(  # noqa: UP032
        versions, platform.system(), platform.machine(), here
    )
    if sys.version_info[:2] > TRIED[-1]:
        text += ", which is newer: where Drake has no package for it, make PYTHON=python3.13 ..."
    return text


def problem():
    # type: () -> str
    """What is missing and how to get it, or an empty text."""
    if sys.version_info < (3, 11):  # noqa: UP036 - this is where it is found out
        return "Python 3.11 or newer is needed; this is {}.{}: make PYTHON=python3.11 …".format(
            *sys.version_info[:2]
        )
    if importlib.util.find_spec("ensurepip") is None:
        return "Python's venv module is missing: sudo apt-get install python3-venv"
    system, machine = platform.system(), platform.machine()
    if system == "Linux" and machine != "x86_64":
        return "Drake has no package for Linux on {}; x86-64 is needed".format(machine)  # noqa: UP032
    if system == "Darwin" and sys.version_info < (3, 13):
        return "on macOS Drake needs Python 3.13 or newer: make PYTHON=python3.13 …"
    if system == "Windows":
        return "use Windows through WSL: Drake has no package for Windows itself"
    if system == "Linux" and not _loads("libglib-2.0.so.0"):
        return (
            "Drake needs the system library libglib2.0: sudo apt-get install libglib2.0-0 "
            "(libglib2.0-0t64 on Debian 13, Ubuntu 24.04 and newer)"
        )
    return ""


def _loads(library):
    # type: (str) -> bool
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


if __name__ == "__main__":
    text = problem()
    if text:
        sys.exit(f"crowdbot: {text} ({tried()})")
    print("crowdbot: " + tried())
