"""For all tests: Ctrl-C works, however the tests were started; examples are drawn alike."""

from __future__ import annotations

import os
import signal

from hypothesis import settings

# A shell without job control starts what runs in the background with SIGINT ignored; tests that
# interrupt, and the processes that they start, would inherit that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# The same examples each time, so that a change is judged by what it changes. To look for new ones:
# HYPOTHESIS_PROFILE=explore.
settings.register_profile("repeat", derandomize=True, max_examples=40)
settings.register_profile("explore", derandomize=False, max_examples=200)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeat"))
