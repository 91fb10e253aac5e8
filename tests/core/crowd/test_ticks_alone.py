"""Several ticks in one call are the same ticks, and end where something has to be recorded."""

from __future__ import annotations

from crowdbot.api import registry
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.build_crowd import build_crowd

TICKS = 128 * 12


def test_the_same_states_at_every_trip_and_decision() -> None:
    world = pick(open_spec("challenge-2020", registry()), "counter-d0125-fast-c20-r05")
    parts = build_environment(registry(), world.environment)
    engine = build_crowd(world, population(world, registry()).agents, parts, registry())
    assert engine is not None
    single, states = engine.initial_state(), [engine.initial_state()]
    for _ in range(TICKS):
        engine.advance(single)
        states.append(single.copy())
    flat, tick, ended_early = engine.initial_state(), 0, 0
    while tick < TICKS:
        trips, most = flat[s.TRIPS], TICKS - tick
        done = engine.advance_alone(flat, most)
        tick += done
        assert flat.tobytes() == states[tick].tobytes()
        assert all(state[s.TRIPS] == trips for state in states[tick - done : tick])
        assert tick % 8 == 0 or flat[s.TRIPS] != trips or tick == TICKS
        ended_early += tick % 8 != 0
    assert ended_early
