"""How fast is the crowd engine, beside other engines on the same corridor?

People walk along a corridor 10 m wide at 0.5 people per square metre; the more there are, the
longer it is. A step is one decision and one move of everybody. One thread, engines interleaved,
the best of several rounds. Peers come with ``pip install --group benchmarks``; those that are not
installed are named. Each runs with its own model and defaults: what is compared is how many people
a simulator moves in a second, not how well.

    python benchmarks/crowd.py --agents 10,100,250,1000,4000 --plot crowd.png
    python benchmarks/crowd.py --umans libUMANS-Library.so
"""

from __future__ import annotations

import argparse
import ctypes
import importlib
import logging
import math
import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from original_steps import FIGURES, whole_step

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld, policy_of

Array = NDArray[np.float64]
Step = Callable[[], object]

WIDTH, DENSITY = 10.0, 0.5  # m, 1/m^2
RADIUS, SPEED, MAX_SPEED, DT = 0.33, 1.2, 3.0, 1.0 / 16.0
PATIENCE = 4.0  # seconds for a step, beyond which an engine is given up
FAR = 10_000.0  # where everybody goes, m
TTCA_DCA = {
    "kind": "ttca_dca", "weight": 20.0, "range": 5.0, "sigma_ttca": 0.3, "sigma_dca": 0.3,
    "sigma_angle_goal": 3.0, "sigma_speed_goal": 0.01,
}  # fmt: skip
RVO = {"kind": "rvo", "range": {"value": 0.3, "measure": "surface"}}


def corridor(count: int) -> tuple[Array, Array]:
    """Starts (N, 2) on a jittered grid and walls (2, 4)."""
    rng = np.random.default_rng(count)
    lanes = 6
    x, y = np.divmod(np.arange(count), lanes)
    pitch = lanes / (DENSITY * WIDTH)
    at = np.column_stack([(x + 0.5) * pitch, (y + 0.5) * WIDTH / lanes - 0.5 * WIDTH])
    half = 0.5 * WIDTH
    walls = np.array([[-50.0, -half, FAR + 50.0, -half], [FAR + 50.0, half, -50.0, half]])
    return at + rng.uniform(-0.25, 0.25, at.shape), walls


def people(count: int) -> tuple[Agents, Array]:
    """The people of the corridor, and its walls."""
    at, walls = corridor(count)
    agents = Agents.of(
        x=at[:, 0], y=at[:, 1], preferred_speed=SPEED, radius=RADIUS, max_speed=MAX_SPEED,
        routes=[[(FAR, y)] for y in at[:, 1].tolist()],
    )  # fmt: skip
    return agents, walls


def crowdbot(policy: dict[str, Any], **costs: dict[str, Any]) -> Callable[[int], Step]:
    def make(count: int) -> Step:
        agents, walls = people(count)
        # A decision in each tick, so that a step is one of both.
        world = CrowdWorld(walls=walls, decision_rate=128.0)
        engine = CrowdEngine(agents, world, policy_of(policy, costs))
        flat = engine.initial_state()
        return lambda: engine.advance(flat)

    return make


def pyrvo(count: int) -> Step:
    library = importlib.import_module("pyrvo")
    at, walls = corridor(count)
    simulation = library.RVOSimulator(DT, 5.0, 10, 5.0, 5.0, RADIUS, MAX_SPEED)
    for place in at.tolist():
        number = simulation.add_agent(tuple(place))
        simulation.set_agent_pref_velocity(number, (SPEED, 0.0))
    for x0, y0, x1, y1 in walls.tolist():
        simulation.add_obstacle([(x0, y0), (x1, y1)])
    simulation.process_obstacles()
    return simulation.do_step  # type: ignore[no-any-return]


def jupedsim(count: int) -> Step:
    library = importlib.import_module("jupedsim")
    at, _ = corridor(count)
    half = 0.5 * WIDTH
    floor = [(-50.0, -half), (FAR + 50.0, -half), (FAR + 50.0, half), (-50.0, half)]
    simulation = library.Simulation(model=library.CollisionFreeSpeedModel(), geometry=floor, dt=DT)
    stage = simulation.add_waypoint_stage((FAR, 0.0), 1.0)
    journey = simulation.add_journey(library.JourneyDescription([stage]))
    for place in at.tolist():
        simulation.add_agent(
            library.CollisionFreeSpeedModelAgentParameters(
                position=tuple(place), desired_speed=SPEED, radius=RADIUS, journey_id=journey,
                stage_id=stage,
            )
        )  # fmt: skip
    return simulation.iterate  # type: ignore[no-any-return]


def pysocialforce(count: int) -> Step:
    library = importlib.import_module("pysocialforce")
    at, _ = corridor(count)
    state = np.column_stack(
        [at, np.full(count, SPEED), np.zeros(count), np.full(count, FAR), at[:, 1]]
    )
    half = 0.5 * WIDTH
    # Walls are points to it; as long as the crowd, for it to be done in finite time.
    end = float(at[:, 0].max()) + 20.0
    simulation = library.Simulator(
        state, obstacles=[(-10.0, end, -half, -half), (-10.0, end, half, half)]
    )
    return simulation.step_once  # type: ignore[no-any-return]


def umans(path: Path) -> Callable[[int], Step]:
    """The original engine's shared library, through its C functions.

    ``bool StartSimulation(const char* file, int threads)``, ``bool DoSimulationSteps(int)`` and
    ``bool CleanUp()``, as its public header declares them.
    """
    library = ctypes.CDLL(str(path))
    library.StartSimulation.argtypes = [ctypes.c_char_p, ctypes.c_int]
    library.DoSimulationSteps.argtypes = [ctypes.c_int]
    for name in ("StartSimulation", "DoSimulationSteps", "CleanUp"):
        getattr(library, name).restype = ctypes.c_bool

    def make(count: int) -> Step:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "simulation.xml"
            file.write_text(_umans_document(count))
            library.CleanUp()  # it holds one simulation at a time
            if not library.StartSimulation(str(file).encode(), 1):
                raise RuntimeError(f"{path} does not take the simulation")
        return lambda: library.DoSimulationSteps(1)

    return make


def _umans_document(count: int) -> str:
    at, walls = corridor(count)
    agents = "".join(
        f'<Agent id="{i}" rad="{RADIUS}" pref_speed="{SPEED}" max_speed="{MAX_SPEED}" '
        f'max_acceleration="5"><pos x="{x}" y="{y}"/><goal x="{FAR}" y="{y}"/>'
        '<Policy id="0"/></Agent>'
        for i, (x, y) in enumerate(at.tolist())
    )
    obstacles = "".join(
        "<Obstacle>"
        + "".join(
            f'<Point x="{x}" y="{y}"/>'
            for x, y in ((x0, y0), (x0, 1.1 * y0), (x1, 1.1 * y1), (x1, y1))
        )
        + "</Obstacle>"
        for x0, y0, x1, y1 in walls.tolist()
    )
    return (
        f'<Simulation delta_time="{DT}" end_time="1e6">'
        f'<World type="Infinite"><Obstacles>{obstacles}</Obstacles></World>'
        '<Policies><Policy id="0" OptimizationMethod="sampling" SamplingType="regular" '
        'SamplingBase="zero" SamplingBaseDirection="preferred velocity" SamplingAngle="180" '
        'SpeedSamples="4" AngleSamples="19" SamplingRadius="preferred speed" '
        'IncludeBaseAsSample="true" RelaxationTime="0.5">'
        '<costfunction name="TtcaDca" coeff="20" range="5" sigmaTtca="0.3" sigmaDca="0.3" '
        'sigmaAngle_goal="3" sigmaSpeed_goal="0.01"/>'
        f'<costfunction name="RVO" coeff="1" range="{0.3 + 2.0 * RADIUS}" w="1"/>'
        f"</Policy></Policies><Agents>{agents}</Agents></Simulation>"
    )


def one_thread() -> None:
    """Start anew with one thread for every library, which they read when they are imported."""
    names = ("OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    if any(os.environ.get(name) != "1" for name in names):
        os.environ.update(dict.fromkeys(names, "1"))
        os.execv(sys.executable, [sys.executable, *sys.argv])


def figures(rounds: int, seconds: float) -> None:
    """Whole steps of 0.1 s with 250 people, beside what the original is known to make."""
    agents, walls = people(250)
    best = dict.fromkeys(FIGURES, 0.0)
    for _ in range(rounds):
        for name, (policy, costs, _, _) in FIGURES.items():
            step = whole_step(policy, costs, agents, walls)
            rate(step, 0.0)
            best[name] = max(best[name], rate(step, seconds))
    print("whole steps of 0.1 s per second of one thread, 250 people, best of", rounds)
    print(f"{'':20} {'steps/s':>9} {'original':>9} {'times':>6} {'asked':>6}")
    for name, (_, _, original, asked) in FIGURES.items():
        print(
            f"{name:20} {best[name]:9.0f} {original:9.0f} {best[name] / original:6.1f} {asked:6.0f}"
        )


def rate(step: Step, seconds: float) -> float:
    """Steps per second of this thread's time, measured for about so long."""
    steps, begin = 0, time.thread_time()
    while (spent := time.thread_time() - begin) < seconds or steps == 0:
        step()
        steps += 1
    return steps / spent


def measure(
    engines: dict[str, Callable[[int], Step]], counts: list[int], rounds: int, seconds: float
) -> dict[str, list[float]]:
    """Best steps per second of each engine for each number of people; NaN where given up.

    The original keeps one simulation for all of them, so each round begins everything anew.
    """
    found: dict[str, list[float]] = {name: [] for name in engines}
    for count in counts:
        best = dict.fromkeys(engines, math.nan)
        for _ in range(rounds):
            for name, make in engines.items():
                before = found[name][-1] if found[name] else math.inf
                if math.isnan(before) or before * PATIENCE < 1.0:
                    continue
                step = make(count)
                rate(step, 0.0)  # compiles, warms up
                best[name] = float(np.fmax(best[name], rate(step, seconds)))
        for name in engines:
            found[name].append(best[name])
        row = (f"{best[n]:20.1f}" if best[n] > 0.0 else f"{'-':>20}" for n in engines)
        print(f"{count:7}", *row, flush=True)
    return found


def plot(found: dict[str, list[float]], counts: list[int], file: Path) -> None:
    matplotlib = importlib.import_module("matplotlib")
    matplotlib.use("Agg")
    figure, axes = importlib.import_module("matplotlib.pyplot").subplots(figsize=(7.0, 4.5))
    for name, rates in found.items():
        axes.loglog(counts, rates, marker="o", label=name)
    axes.set_xlabel("people")
    axes.set_ylabel("steps per second, one thread")
    axes.set_title("The same corridor, 0.5 people per square metre")
    axes.grid(visible=True, which="both", alpha=0.3)
    axes.legend()
    figure.tight_layout()
    figure.savefig(file, dpi=120)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--agents", default="10,50,100,250,500,1000,2000,4000")
    parser.add_argument("--rounds", type=int, default=3, help="the best of so many counts")
    parser.add_argument("--seconds", type=float, default=0.5, help="length of one measurement")
    parser.add_argument("--figures", action="store_true", help="only the three named figures")
    parser.add_argument("--plot", type=Path, help="PNG file to draw")
    parser.add_argument("--umans", type=Path, help="the original's shared library")
    given = parser.parse_args()
    one_thread()
    logging.disable(logging.INFO)  # a peer turns everybody's debug messages on

    figures(max(given.rounds, 10), min(given.seconds, 0.2))
    if given.figures:
        return
    sampling = {"kind": "velocity_space"}
    engines: dict[str, Callable[[int], Step]] = {
        "crowdbot challenge": crowdbot(sampling, mid_term=TTCA_DCA, reflex=RVO),
        "crowdbot rvo": crowdbot(sampling, reflex={"kind": "rvo"}),
    }
    for peer in (pyrvo, jupedsim, pysocialforce):
        try:
            importlib.import_module(peer.__name__)
        except ImportError as error:
            print(f"{peer.__name__}: not installed ({error})")
        else:
            engines[peer.__name__] = peer
    if given.umans:
        engines["umans challenge"] = umans(given.umans.resolve())

    counts = [int(n) for n in given.agents.split(",")]
    print("steps per second, one thread, best of", given.rounds)
    print(f"{'people':>7}", *(f"{name:>20}" for name in engines))
    found = measure(engines, counts, given.rounds, given.seconds)
    if given.plot:
        plot(found, counts, given.plot)


if __name__ == "__main__":
    main()
