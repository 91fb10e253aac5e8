"""Judge sealed submissions: receive them before the draws are opened, then run each by itself."""

from __future__ import annotations

import hashlib
import shutil
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from crowdbot.core.bundle.judge_log import LOG, RECEIVED, LogLine, append, read_log
from crowdbot.core.bundle.manifest import Manifest
from crowdbot.core.bundle.pack import Submission, pack
from crowdbot.core.bundle.signature import own_public_key
from crowdbot.core.bundle.submission import SUFFIX, Sealed, read_submission, unpack_submission
from crowdbot.core.bundle.verification import JUDGED, content_hash, save_verification
from crowdbot.core.campaign.plan import Plan, make_plan
from crowdbot.core.campaign.request import CampaignRequest
from crowdbot.core.campaign.run import State
from crowdbot.core.planning.containment.offer import kernel_offer
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.run_options import USUAL, RunOptions
from crowdbot.core.scenarios.library import open_suite
from crowdbot.dsl.scenario.lock import LockFiles
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import (
    CrowdbotError,
    InputError,
    Interrupted,
    PluginError,
    SimulationError,
    UnknownNameError,
)

_OPENED, _REFUSED, _INCOMPLETE = "opened", "refused", "incomplete"
_SHORT, _REASON = 16, 500


@dataclass(frozen=True, kw_only=True)
class Judge:
    """Receives and runs the sealed submissions of one suite.

    Attributes:
        suite: file or name of the suite.
        submissions: folder of the sealed planners.
        out: folder of the log, the runs and the bundles.
        run: function that makes the missing runs of a plan, on this machine or a cluster.
        options: options of the runs.
    """

    suite: str
    submissions: Path
    out: Path
    registry: Registry
    run: Callable[[Plan], State]
    options: RunOptions = USUAL
    plugins: Sequence[Path] = ()


@dataclass(kw_only=True)
class Judgement:
    """The outcome of `judge`.

    Attributes:
        received, judged: submissions received and judged in this call, by file name.
        left_out: name of the file -> reason.
        waits: True if the draws are hidden, so that nothing was run.
    """

    received: list[str] = field(default_factory=list)
    judged: dict[str, Path] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)
    waits: bool = False


def judge(setup: Judge) -> Judgement:
    """Receive new submissions; if the draws are open, run all that were received before.

    Completed runs are not made again. Submissions are run one after another, each from a folder
    of its own that exists only while it runs.

    Raises:
        InputError: the log was changed, is that of another suite, the folder has no submission, or
            planners would not be contained.
        CrowdbotError: the suite is invalid, or runs cannot be made at all; the same call goes on.
    """
    expansion, lock = open_suite(setup.suite, setup.registry)
    path = setup.out / LOG
    own = own_public_key()
    lines = read_log(path, {own} - {""})
    judgement = Judgement()
    hidden = any(scenario.hidden for scenario in expansion.scenarios)
    closed = expansion.round.problem(datetime.now(UTC)) if expansion.round else ""
    if expansion.commitment and not hidden:
        closed = closed or "not received before the draws were revealed"
    sealed = dict(_received(setup, path, lines, judgement, closed))
    if hidden:
        judgement.waits = True
        return judgement
    if setup.options.place.contained and (missing := kernel_offer().missing):
        raise InputError(
            f"planners would not be contained ({missing}); --not-contained runs them all the same"
        )
    _open_draws(expansion, lock, path, lines)
    done = {str(x.document["submission"]) for x in lines if x.event in (JUDGED, _REFUSED)}
    for digest, one in sealed.items():
        if digest not in done:
            _judge_one(setup, (expansion, lock), one, path, lines, judgement)
    return judgement


def _received(
    setup: Judge, path: Path, lines: list[LogLine], judgement: Judgement, closed: str
) -> Iterator[tuple[str, Sealed]]:
    """Yield the submissions that were received in time, after logging new ones.

    ``closed``: why no new submission is accepted now; empty if they are accepted.
    """
    files = sorted(setup.submissions.glob(f"*{SUFFIX}"))
    if not files:
        raise InputError(f"{setup.submissions}: no submissions (*{SUFFIX}) there")
    known = {str(x.document["submission"]) for x in lines if x.event == RECEIVED}
    opened = any(x.event == _OPENED for x in lines)
    for file in files:
        try:
            one = read_submission(file)
        except InputError as error:
            judgement.left_out[file.name] = str(error).removeprefix(f"{file}: ")
            continue
        if one.sha256 not in known:
            if opened or closed:
                judgement.left_out[file.name] = closed or "handed in after the draws were opened"
                continue
            about = one.about
            append(
                path, lines, RECEIVED, submission=one.sha256, team=about.team,
                planner=about.planner, settings=about.settings, digest=about.digest,
            )  # fmt: skip
            known.add(one.sha256)
            judgement.received.append(file.name)
        yield one.sha256, one


def _open_draws(expansion: Expansion, lock: LockFiles, path: Path, lines: list[LogLine]) -> None:
    """Log that the draws are known from now on, or check that they are those of the log."""
    ids = "\n".join(s.id for s in expansion.scenarios)
    there = lock.lock_path.exists()
    about = {
        "suite": expansion.suite_id,
        "commitment": expansion.commitment,
        "scenarios": hashlib.sha256(ids.encode()).hexdigest(),
        "lock": content_hash(lock.lock_path) if there else "",
        "seeds": list(expansion.run_seeds),
    }
    before = next((x.document for x in lines if x.event == _OPENED), None)
    if before is None:
        append(path, lines, _OPENED, **about)
    elif other := [key for key, value in about.items() if before.get(key) != value]:
        raise InputError(f"{path}: it is the log of another suite: {', '.join(other)} differ")


def _judge_one(
    setup: Judge,
    suite: tuple[Expansion, LockFiles],
    sealed: Sealed,
    path: Path,
    lines: list[LogLine],
    judgement: Judgement,
) -> None:
    """Make the runs of one submission, pack them and log it, or log why not."""
    name = sealed.path.name
    bundle = setup.out / f"{sealed.sha256[:_SHORT]}.cbz"
    try:
        state, label = _run_all(setup, sealed)
        manifest = _packed(setup, suite, sealed, state, label, bundle)
    except _LeftOutError as error:
        append(path, lines, error.event, submission=sealed.sha256, reason=str(error)[:_REASON])
        judgement.left_out[name] = str(error)
        return
    record = _record(bundle, sealed, [f"{r.scenario} seed-{r.seed}" for r in manifest.runs])
    save_verification(bundle, record)
    append(
        path, lines, JUDGED, submission=sealed.sha256, bundle=record["sha256"],
        runs=len(manifest.runs), statuses=dict(Counter(state.statuses.values())),
    )  # fmt: skip
    judgement.judged[name] = bundle


class _LeftOutError(Exception):
    """A submission is not judged, now or ever; ``event`` is its entry in the log."""

    def __init__(self, event: str, reason: str) -> None:
        super().__init__(reason if event == _REFUSED else f"{reason}; the same command goes on")
        self.event = event


def _run_all(setup: Judge, sealed: Sealed) -> tuple[State, str]:
    """Make all runs of a submission; return their states, and the planner's label.

    Raises:
        _LeftOutError: it is refused, or runs are missing.
    """
    folder = setup.out / "planners" / sealed.sha256[:_SHORT]
    try:
        request, label = _prepared(setup, sealed, folder)
        state = _made(setup, request)
    except (InputError, PluginError) as error:
        raise _LeftOutError(_REFUSED, str(error)) from error
    except SimulationError as error:  # not the submission's: others are judged, and it is later
        raise _LeftOutError(_INCOMPLETE, str(error)) from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    if state.failures:
        raise _LeftOutError(_INCOMPLETE, f"{len(state.failures)} runs could not be made")
    return state, label


def _packed(
    setup: Judge,
    suite: tuple[Expansion, LockFiles],
    sealed: Sealed,
    state: State,
    label: str,
    bundle: Path,
) -> Manifest:
    """Pack the runs of a submission.

    Raises:
        _LeftOutError: they cannot be packed; the next submission is judged all the same.
    """
    about = sealed.about
    submission = Submission(
        root=state.plan.out, planner=label, team=about.team, contact=about.contact, failing=True,
        recordings=setup.options.record != "none",
    )  # fmt: skip
    try:
        return pack(submission, *suite, setup.registry, bundle)
    except (InputError, UnknownNameError) as error:
        raise _LeftOutError(_INCOMPLETE, f"its runs cannot be packed: {error}") from error


def _prepared(setup: Judge, sealed: Sealed, folder: Path) -> tuple[CampaignRequest, str]:
    """Unpack a submission and load its planner; return the request for its runs, and its label.

    Raises:
        InputError, PluginError: it is not what was sealed, or may not be run.
        SimulationError: it cannot be unpacked here.
    """
    if folder.exists():  # of an interrupted time
        shutil.rmtree(folder)
    folder.mkdir(parents=True, mode=0o700)
    about = sealed.about
    _, colon, kind = about.planner.partition(":")
    try:
        text = f"{unpack_submission(sealed, folder)}{colon}{kind}"
    except OSError as error:
        where = error.filename or folder
        raise SimulationError(f"{where}: cannot be written: {error.strerror or error}") from None
    options = replace(setup.options, place=replace(setup.options.place, sealed=folder.resolve()))
    choice = resolve_planner(text, setup.registry, about.settings, options.place)
    if choice.digest != about.digest:
        raise InputError(f"{about.planner} is not the planner that was sealed")
    request = CampaignRequest(
        suites=[setup.suite],
        planners=[text],
        planner_settings=about.settings,
        out=setup.out / "runs" / sealed.sha256[:_SHORT],
        options=options,
        plugins=setup.plugins,
    )
    return request, choice.label


def _made(setup: Judge, request: CampaignRequest) -> State:
    """Make the missing runs of a request.

    Raises:
        SimulationError: they cannot be made now.
    """
    try:
        return setup.run(make_plan(request, setup.registry))
    except Interrupted:
        raise
    except CrowdbotError as error:
        raise SimulationError(str(error)) from error


def _record(bundle: Path, sealed: Sealed, names: Sequence[str]) -> dict[str, Any]:
    """Return the record that lies beside the bundle, as after a verification."""
    return {
        "outcome": JUDGED,
        "ok": True,
        "sha256": content_hash(bundle),
        "submission": sealed.sha256,
        "runs": dict.fromkeys(names, JUDGED),
    }
