"""Choose a trained policy as a planner."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from crowdbot.core.learning.conventions import Conventions
from crowdbot.core.planning.choice import PlannerChoice, label_of
from crowdbot.core.planning.planner import Planner
from crowdbot.core.planning.policies.onnx_policy import load_onnx
from crowdbot.core.planning.policies.policy_name import SB3, policy_file
from crowdbot.core.planning.policies.policy_planner import Policy, PolicyPlanner
from crowdbot.core.planning.policies.sb3_policy import load_sb3
from crowdbot.core.planning.unchanged_files import UnchangedFiles
from crowdbot.core.registry.registry import Registry
from crowdbot.core.support.text_files import suggest_files
from crowdbot.dsl.spec.assets import sha256_of
from crowdbot.errors import InputError


def policy_choice(text: str, given: Mapping[str, Any], registry: Registry) -> PlannerChoice:
    """Return the planner of a policy, which runs in this process: its file holds no code.

    Raises:
        InputError: there is no such file, it cannot be read, or it was given parameters.
        MissingLibraryError: the library that runs it is not installed.
    """
    path = policy_file(text)
    if not path.is_file():
        raise InputError(f"{path}: no such file{suggest_files(path)}")
    if given:
        raise InputError(
            f"{path}: a trained policy takes no parameters; leave out '{next(iter(given))}'"
        )
    _, conventions = _load(text, registry)
    sha256 = sha256_of(path)

    def build() -> Planner:
        policy, own = _load(text, registry)
        return PolicyPlanner(policy, own, registry, path.name)

    observation = conventions.observation
    return PlannerChoice(
        name=path.stem,
        spec_dump={"kind": path.name, "sha256": sha256},
        build=UnchangedFiles(build, lambda: sha256_of(path), sha256, str(path)),
        pinned=False,
        origin=str(path),
        needs=observation.needs,
        label=label_of(path.stem, {}, observation.privileged),
        privileged=observation.privileged,
        in_process=True,
    )


def _load(text: str, registry: Registry) -> tuple[Policy, Conventions]:
    load = load_sb3 if text.startswith(SB3) else load_onnx
    return load(policy_file(text), registry)
