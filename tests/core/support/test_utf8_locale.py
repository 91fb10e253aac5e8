"""A locale that is not UTF-8."""

from __future__ import annotations

import os
import subprocess
import sys


def test_drake_is_imported_in_an_ascii_locale() -> None:
    ascii_only = {"LC_ALL": "POSIX", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
    done = subprocess.run(
        [sys.executable, "-c", "import crowdbot.core.sim.plant; print('there')"],
        env=os.environ | ascii_only, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.stdout == "there\n", done.stderr
