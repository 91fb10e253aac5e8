"""Runs in which a person walks in the crowd: ordinary runs with one more pedestrian."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from crowdbot.core.live.live_record import with_live_part
from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.person.seat import Seat
from crowdbot.core.live.person.teleop import live_part
from crowdbot.core.live.person.walking import SIGNALS, Steps, led_by
from crowdbot.core.live.session import LiveSession
from crowdbot.core.recording.recording import Recording
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.identity import Prepared, prepare
from crowdbot.core.runs.run import Request, Run
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError


def seat_in_the_crowd(interrupted: Callable[[], bool], rate: float = 1.0) -> Seat:
    """Return the place of a person who walks in the crowd."""
    session = LiveSession(interrupted=interrupted, robots={"": LiveRobot(name="person")})
    return Seat(session, rate=rate)


def walk(
    request: Request, builts: Mapping[str, BuiltRun], seat: Seat, without: Scenario, speed: float
) -> Run:
    """Make the run of a person who walks; its calibration runs are those without the person.

    Args:
        request: of the scenario with the person.
        builts: runs of its robots; none of people alone.
        without: the scenario without the person.
        speed: of full deflection, m/s.

    Raises:
        Interrupted: the user stopped the run; a ``.partial`` directory is left.
    """
    from crowdbot.core.sim.simulate import make_run

    session = seat.session
    session.begin(request.scenario.id, request.seed, ("person",))
    led = replace(request, on_crowd=led_by(Steps(seat, speed)), stop=lambda: session.must_stop)
    run = make_run(led, _prepared(request, without), builts=builts)
    return with_live_part(run, live_part(seat.log, session.counts.refused))


def walk_again(
    request: Request, builts: Mapping[str, BuiltRun], without: Scenario, folder: Path
) -> Run:
    """Repeat a recorded walk with its velocities, without a person.

    Raises:
        InputError: it cannot be read, or no person walked in it.
    """
    from crowdbot.core.sim.simulate import make_run

    again = replace(request, on_crowd=led_by(recorded_steps(folder)))
    return make_run(again, _prepared(request, without), builts=builts)


def recorded_steps(folder: Path) -> Callable[[float], tuple[float, float]]:
    """Return the velocity (m/s) at each step of a recorded walk; none afterwards.

    Raises:
        InputError: it cannot be read, or no person walked in it.
    """
    path = folder / files.RECORDING if folder.is_dir() else folder
    with Recording(path) as recording:
        names = recording.robots
        run = recording.robot(names[0] if len(names) > 1 else None).run
    columns = [run.signals.get(name) for name in SIGNALS]
    if columns[0] is None or columns[1] is None:
        raise InputError(f"{folder}: no person walks in it: 'crowdbot walk' records that")
    velocities = {t: (x, y) for (t, x), (_, y) in zip(*(c.tolist() for c in columns), strict=True)}  # type: ignore[union-attr]
    return lambda t: velocities.get(t, (0.0, 0.0))


def _prepared(request: Request, without: Scenario) -> Prepared:
    """Return the people of the run, and its calibration runs without the person."""
    own = prepare(request.scenario, request.registry, references=False, people_alone=True)
    compared = request.options.references and without.crowd is not None
    if not compared or not without.robots:
        return own
    return replace(prepare(without, request.registry), run=own.run)
