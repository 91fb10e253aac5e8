"""The page of ``crowdbot study run``: served until the participant is done, or Ctrl-C."""

from __future__ import annotations

import signal
import threading
from typing import TYPE_CHECKING, Any

from crowdbot.cli.output.say import say
from crowdbot.core.studies.runner.server import RunnerServer
from crowdbot.core.studies.runner.session import RunnerSession

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.studies.progress import StudyProgress

#: The last page stays for so long, s.
_STAYS = 5.0


def serve_participant(
    progress: StudyProgress, registry: Registry, *, port: int, synthetic: bool
) -> None:
    """Serve a participant's page until the last step is done, or until a signal.

    Raises:
        InputError: the port cannot be opened.
    """
    session = RunnerSession(progress, registry, synthetic=synthetic)
    server = RunnerServer(session, port)
    stop = threading.Event()
    before = [(s, signal.signal(s, _setting(stop))) for s in (signal.SIGINT, signal.SIGTERM)]
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    say(f"{progress.participant}: open {server.url}", err=True)
    try:
        while not stop.wait(0.5) and not session.is_over:
            pass
        stop.wait(_STAYS if session.is_over else 0.0)
    finally:
        session.close()
        server.shutdown()
        server.server_close()
        for number, handler in before:
            signal.signal(number, handler)
    done = len(progress.done())
    say(f"{progress.participant}: {done} of {len(progress.steps)} steps are done")


def _setting(stop: threading.Event) -> Any:
    def handler(number: int, frame: object) -> None:
        del number, frame
        stop.set()

    return handler
