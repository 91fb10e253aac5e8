"""For all tests: Ctrl-C works, however the tests were started."""

from __future__ import annotations

import signal

# A shell without job control starts what runs in the background with SIGINT ignored; tests that
# interrupt, and the processes that they start, would inherit that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
