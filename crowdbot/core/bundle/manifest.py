"""The manifest of a bundle: contents, author, and rules."""

from __future__ import annotations

import json
from typing import Annotated, Any, Literal

from annotated_types import Ge
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from crowdbot.core.support.strict_json import parse_json
from crowdbot.dsl.suite.round import HandedIn
from crowdbot.errors import InputError, hidden_character

#: Version of the bundle format of this release.
BUNDLE = 1
MANIFEST, LOCK = "bundle.json", "suite.lock.json"
#: Folder of files that the planner reads, named by their SHA-256.
PLANNER_FILES = "planner/"

#: Version of the bundle rules, raised when they change.
RULES = 2
RULES_TEXT = (
    "One planner with one set of parameters drives all scenarios of the suite.",
    "Every scenario is run with the seeds of the suite; no run is left out, however it ended.",
    "A planner that reads ground truth says so and is ranked apart.",
    "A planner is deterministic: the same observations and seed give the same commands.",
    "Scenarios, rates and metrics are those of the suite, unchanged.",
)


def _shown_alike(text: str) -> str:
    """Return a name after checking that it holds no invisible or bidirectional characters.

    Raises:
        ValueError: it contains invisible or bidirectional characters.
    """
    hidden = hidden_character(text, allowed="")
    if hidden:
        raise ValueError(f"the character {hidden} is not one that is shown")
    return text


#: One line of text for a team or contact.
Name = Annotated[str, Field(max_length=200), AfterValidator(_shown_alike)]
_NAME: TypeAdapter[str] = TypeAdapter(Name)
Class = Literal["privileged", "sensors only", "driven by a person"]


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class Member(_Model):
    """One file of the archive."""

    sha256: Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
    size: Annotated[int, Ge(0)]


class Edition(_Model):
    """The suite and rules of a bundle.

    Attributes:
        suite, title: id and title of the suite.
        lock: SHA-256 of its lock, or empty.
        scenarios: number of scenarios.
        rules: version of the rules.
        closes: day or moment at which the suite's round closes; empty: never.
        handed_in: ``sealed`` if only planners that the organisers ran are ranked.
    """

    suite: str
    title: str
    lock: str
    scenarios: int
    rules: int
    closes: str = ""
    handed_in: HandedIn = "any"

    @property
    def name(self) -> str:
        """Return a readable name; the manifest's own also contains the seeds."""
        return f"{self.suite} · {self.lock[:8] or 'no lock'} · rules {self.rules}"


class BundledRun(_Model):
    """One run: the names of its files in the archive, and the hashes that identify it."""

    scenario: str
    seed: int
    directory: str
    run_id: str
    trajectory: str


class Manifest(_Model):
    """The manifest of a bundle: the content of ``bundle.json``.

    Attributes:
        planner: as in ``run.json``: kind, name, label and every parameter.
        classed: class of the planner: sensors only, privileged, or driven by a person.
        versions: software versions, equal in all runs.
        seeds: seeds of the edition; each scenario has a run with each.
        missing: ``ID seed-N`` of runs missing in a partial bundle.
    """

    bundle: Annotated[int, Ge(1)]
    crowdbot: str
    team: Name
    contact: Name
    edition: Edition
    planner: dict[str, Any]
    classed: Class
    pinned: bool
    versions: dict[str, str]
    seeds: list[int]
    missing: list[str]
    runs: list[BundledRun]
    members: dict[str, Member]

    @property
    def edition_name(self) -> str:
        """Return a readable name: bundles with equal names may be ranked together."""
        seeds = "" if self.seeds == [0] else f" · seeds {_ranges(self.seeds)}"
        return f"{self.edition.name}{seeds}"

    @property
    def label(self) -> str:
        """Return the planner's label."""
        return str(self.planner.get("label", ""))

    def text(self) -> str:
        """Return the file's text."""
        content = self.model_dump(mode="json")
        content["edition"] = self.edition.model_dump(mode="json", exclude_defaults=True)
        return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def name_problem(text: str) -> str:
    """Return why a text is not a valid team or contact; empty if it is."""
    try:
        _NAME.validate_python(text)
    except ValidationError as error:
        return error.errors()[0]["msg"].removeprefix("Value error, ")
    return ""


def _ranges(seeds: list[int]) -> str:
    """Return ranges such as ``0-4, 7``."""
    parts: list[list[int]] = []
    for seed in sorted(set(seeds)):
        if parts and seed == parts[-1][-1] + 1:
            parts[-1].append(seed)
        else:
            parts.append([seed])
    return ", ".join(str(p[0]) if len(p) == 1 else f"{p[0]}-{p[-1]}" for p in parts)


def parse_manifest(text: str) -> Manifest:
    """Parse a manifest.

    Raises:
        InputError: it is not a manifest, or a newer release wrote it.
    """
    try:
        content = parse_json(text)
        version = content.get("bundle") if isinstance(content, dict) else None
        if isinstance(version, int) and version > BUNDLE:
            raise InputError(
                f"{MANIFEST} has format {version}; this release reads {BUNDLE}: upgrade crowdbot"
            )
        return Manifest.model_validate(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        message = first["msg"].removeprefix("Value error, ")
        raise InputError(f"{MANIFEST} is not a manifest: {place}: {message}") from None
    except ValueError as error:
        raise InputError(f"{MANIFEST} is not a manifest: {error}") from None
