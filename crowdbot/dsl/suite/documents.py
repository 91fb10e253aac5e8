"""The fields of a suite and of a document with one scenario."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from annotated_types import Ge, Le
from pydantic import Field, WithJsonSchema

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.spec import Spec
from crowdbot.dsl.suite.commitment import COMMITMENT, SALT
from crowdbot.dsl.suite.matrix import MAX_COMBINATIONS
from crowdbot.dsl.suite.round import Round
from crowdbot.dsl.text.path_names import PathName

#: Version of the document format of this release.
FORMAT = 1
#: What a recording holds.
Recorded = Literal["all", "used", "none"]
MAX_RUN_SEEDS = 1000
_LABELS = {"anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}]}
_CHOICE = {"type": "object", "additionalProperties": _LABELS, "minProperties": 1}
_CHOICES = {
    "anyOf": [_CHOICE, {"type": "array", "items": _CHOICE, "minItems": 1}, {"type": "null"}]
}
#: Checked by `read_selection`, which knows the axes.
_Choices = Annotated[Any, WithJsonSchema(_CHOICES)]
#: Checked by `check_versions`.
_Versions = Annotated[
    Any,
    WithJsonSchema({"type": "object", "additionalProperties": {"type": "integer", "minimum": 1}}),
]


class CommittedFile(Spec):
    """A file of a suite whose draws are hidden: its content is covered by the commitment."""

    path: str = Field(min_length=1, description="Path from the suite's file.")
    sha256: str = Field(pattern=r"^[0-9a-f]{64}$", description="Of the content.")


class SuiteHead(Spec):
    """Name, title and seed of a suite."""

    id: PathName = Field(pattern=r"^[A-Za-z0-9_.-]+$", description="Name of the suite.")
    title: str = default("", "What the suite is about, for people who read a list of suites.")
    seed: Annotated[int, Ge(0), Le(2**63 - 1)] = default(0, "Root of every crowd's random numbers.")
    commitment: str | None = default(
        None, "Hash of seed, salt and document, published before the seed is.", pattern=COMMITMENT
    )
    salt: str | None = default(
        None,
        "Hexadecimal digits that reveal the seed of a commitment, together with it.",
        pattern=SALT,
    )
    files: tuple[CommittedFile, ...] = default(
        (),
        "Files that the document names, such as a floor plan, and that have to stay as "
        "they are; written by `crowdbot draws commit`.",
        strict=False,
    )


class Seeds(Spec):
    """Axes that change the random numbers; combinations that differ in other axes share them."""

    crowd: tuple[str, ...] | None = default(
        None, "Axes that change the drawn crowd; default: all.", strict=False
    )
    runs: tuple[Annotated[int, Ge(0), Le(2**63 - 1)], ...] = default(
        (0,),
        "Run seeds that a bundle of this suite consists of, in rising order.",
        strict=False,
        min_length=1,
        max_length=MAX_RUN_SEEDS,
    )


class SuiteDocument(Spec):
    """The outermost fields of a suite."""

    crowdbot: int = Field(description="Version of the format.")
    suite: SuiteHead
    base: dict[str, Any] = Field(description="What all scenarios have in common.")
    matrix: Any = default(
        None, "Axes of variation: axis, label, and the fields that the label overrides."
    )
    only: _Choices = default(
        None,
        "Combinations that stay: labels by axis, or a list of such maps, of which one has to fit.",
    )
    exclude: _Choices = default(None, "Combinations that are left out, written as in `only`.")
    draws: Annotated[int, Ge(1), Le(MAX_COMBINATIONS)] = default(
        1, "Crowd draws of each condition: as many scenarios, with other people each."
    )
    seeds: Seeds | None = default(None, "Axes of the random numbers.")
    metrics: list[str] | None = default(None, "Metrics to score; default all.")
    record: Recorded | None = default(
        None, "What `crowdbot simulate` records where it is not told; outside the hash."
    )
    round: Round | None = default(None, "Dates and rules of a challenge; outside the hash.")
    references: dict[str, dict[str, Any]] = default({}, "Calibration runs.")
    kinds: _Versions = default(None, "Least spec_version of components, by kind.")


class ScenarioDocument(Spec):
    """The outermost fields of a single scenario."""

    crowdbot: int = Field(description="Version of the format.")
    scenario: dict[str, Any] = Field(description="All fields of one scenario.")
    metrics: list[str] | None = default(None, "Metrics to score; default all.")
    record: Recorded | None = default(
        None, "What `crowdbot simulate` records where it is not told; outside the hash."
    )
    references: dict[str, dict[str, Any]] = default({}, "Calibration runs.")
    kinds: _Versions = default(None, "Least spec_version of components, by kind.")
