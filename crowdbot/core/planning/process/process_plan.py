"""ProcessPlan: the program of a planner process, checked before it starts."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import msgpack

from crowdbot.core.planning.containment.offer import Needs, kernel_offer
from crowdbot.errors import InputError

_LOG = logging.getLogger("crowdbot")
_GIB = 1 << 30


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessPlan:
    """The program of a planner process.

    Attributes:
        title: start of every message about it.
        own_side: for a planner in our Python, argument of `OwnSide`.
        command: for any other program, its command line.
        folder: its working directory; empty: that of the simulator.
        parameters: its parameters; another program gets them in ``hello``.
        preload: installed modules that are imported before the process is forked.
        memory: largest address space, bytes; None: unlimited.
        needs: files and network that it asks for.
        beside: folder of the data that its description declares.
        contained: True to refuse to run it where it would not be contained.
        sealed: folder that holds all that it may declare; None: it may declare more.
    """

    title: str
    own_side: Mapping[str, Any] | None = None
    command: Sequence[str] = ()
    folder: str = ""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    preload: Sequence[str] = ()
    memory: int | None = 4 * _GIB
    needs: Needs = field(default_factory=Needs)
    beside: Path | None = None
    contained: bool = False
    sealed: Path | None = None


def check_plan(plan: ProcessPlan) -> None:
    """Check that a planner may start, and that its parameters can be sent.

    Raises:
        InputError: it may not, or they cannot.
    """
    _check_parameters(plan)
    check_sealed(plan)
    _check_containment(plan)


def check_sealed(plan: ProcessPlan) -> None:
    """Raise an error if a sealed planner needs files beyond the sealed ones.

    Raises:
        InputError: it declares other files, or asks for the network.
    """
    if plan.sealed is not None and (beyond := plan.needs.beyond(plan.sealed)):
        raise InputError(f"{plan.title}: a sealed planner {beyond}")


def _check_containment(plan: ProcessPlan) -> None:
    """Warn once per process that planners are not contained here, or refuse to run one.

    Raises:
        InputError: it has to be contained.
    """
    missing = kernel_offer().missing
    if missing and plan.contained:
        raise InputError(
            f"{plan.title}: it would not be contained ({missing}); "
            "--not-contained runs it all the same"
        )
    if missing:
        _say_uncontained(missing)


@cache
def _say_uncontained(missing: str) -> None:
    _LOG.warning("warning: planners are not contained: %s", missing)


def _check_parameters(plan: ProcessPlan) -> None:
    """Check that the parameters can be sent.

    Raises:
        InputError: one has a type of YAML that msgpack does not have, such as a date.
    """
    try:
        msgpack.packb(dict(plan.parameters))
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{plan.title}: its parameters cannot be sent: {error}") from None
