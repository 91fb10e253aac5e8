"""The choice of a planner that is a class in a Python file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from crowdbot.core.planning.choice import PlannerChoice, PlannerPlace, label_of
from crowdbot.core.planning.containment.declared import needs_of_class
from crowdbot.core.planning.description import PlannerDescription, described
from crowdbot.core.planning.guarded import planner_title
from crowdbot.core.planning.planner import Planner
from crowdbot.core.planning.process.describe import describe
from crowdbot.core.planning.process.process_plan import ProcessPlan
from crowdbot.core.planning.python_file import (
    build_of_class,
    call_of_class,
    check_parameters,
    planner_class,
    preloads,
)
from crowdbot.core.planning.unchanged_files import while_unchanged
from crowdbot.core.support.source_digest import check_source, source_digest
from crowdbot.core.support.text_files import suggest_files
from crowdbot.errors import InputError


def class_choice(
    path: Path, name: str, parameters: Mapping[str, Any], place: PlannerPlace
) -> PlannerChoice:
    """Return the planner of a class; by default it runs in a separate process.

    Raises:
        InputError: there is no such file or class, or a parameter is wrong.
        PlannerError: the file cannot be imported.
    """
    if not path.is_file():
        raise InputError(f"{path}: no such file{suggest_files(path)}")
    check_source(path)
    in_process = place.in_process is True
    if in_process:
        description, build = _imported(path, name, parameters)
    else:
        plan = _process_of_class(path, name, parameters, place)
        description, build = describe(plan, lenient=place.lenient)
    digest = partial(source_digest, path, description.data)
    sha256 = digest()
    dump = {
        "kind": f"{path.name}:{name}",
        "sha256": sha256,
        **({"parameters": dict(parameters)} if parameters else {}),
    }
    return PlannerChoice(
        name=name,
        spec_dump=dump,
        build=while_unchanged(build, digest, sha256, str(path)),
        pinned=False,
        origin=str(path),
        needs=description.needs,
        label=label_of(name, parameters, description.privileged),
        privileged=description.privileged,
        role="candidate" if parameters else description.role,
        in_process=in_process,
        memory=place.own_memory(in_process),
    )


def _imported(
    path: Path, name: str, parameters: Mapping[str, Any]
) -> tuple[PlannerDescription, Callable[[], Planner]]:
    """Import a class into this process; return its description, and what builds it."""
    kind = planner_class(path, name)
    check_parameters(kind, parameters, f"{path}:{name}")
    build = partial(build_of_class, kind, parameters, path, name)
    return described(kind, call_of_class(path, name)), build


def _process_of_class(
    path: Path, name: str, parameters: Mapping[str, Any], place: PlannerPlace
) -> ProcessPlan:
    """Return the process in which a class runs."""
    return ProcessPlan(
        title=planner_title(name, str(path)),
        own_side={
            "name": name,
            "origin": str(path),
            "file": str(path),
            "class": name,
            "parameters": dict(parameters),
        },
        preload=preloads(path),
        memory=place.memory,
        contained=place.contained,
        sealed=place.sealed,
        needs=needs_of_class(path, name),
        beside=path.parent,
    )
