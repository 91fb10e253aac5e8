"""The loop of the replication card is the test of its source."""

from __future__ import annotations

import argparse
import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np

ROOT = Path(__file__).parents[4]


def _loop() -> ModuleType:
    spec = importlib.util.spec_from_file_location(
        "learned_replication", ROOT / "benchmarks" / "learned_replication.py"
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["learned_replication"] = module
    spec.loader.exec_module(module)
    return module


def test_orca_among_people_who_do_not_see_it_ends_as_published() -> None:
    """CrowdNav (Chen et al., ICRA 2019, Table I): 0.43 arrive, 0.57 collide, in 10.86 s."""
    loop = _loop()
    given = argparse.Namespace(
        humans=5, radius=4.0, people="orca", step=loop.STEP, limit=25.0, visible=False
    )
    ends = [loop.case(loop.Orca(), np.random.default_rng([0, n]), given) for n in range(200)]
    # Three standard errors of 200 cases, and of their 500, are 0.12.
    assert abs(np.mean([end == "arrived" for end, *_ in ends]) - 0.43) < 0.12
    assert abs(np.mean([end == "hit" for end, *_ in ends]) - 0.57) < 0.12
    assert abs(np.mean([t for end, t, _ in ends if end == "arrived"]) - 10.86) < 0.5
