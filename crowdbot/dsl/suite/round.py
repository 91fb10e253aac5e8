"""A round of a challenge: dates and form of submissions, and the contact."""

from __future__ import annotations

import re
from datetime import UTC, datetime, time
from typing import Annotated, Literal

from pydantic import AfterValidator, WithJsonSchema, model_validator

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.spec import Spec

#: The form in which planners are handed in.
HandedIn = Literal["any", "sealed"]
_TEXT, _LONG_TEXT = 500, 10_000


def _moment(text: str) -> str:
    """Return the text unchanged if it is a day, or a moment with a time zone.

    Raises:
        ValueError: it is neither.
    """
    try:
        if datetime.fromisoformat(text).tzinfo is not None or len(text) == len("2027-01-31"):
            return text
    except ValueError:
        pass
    raise ValueError("write a day such as 2027-01-31, or a moment such as 2027-01-31T12:00Z")


Moment = Annotated[
    str,
    AfterValidator(_moment),
    WithJsonSchema({"type": "string", "pattern": r"^\d{4}-\d\d-\d\d([T ].*(Z|[+-]\d\d:?\d\d))?$"}),
]


class Round(Spec):
    """A round of a challenge; all days begin and end in UTC."""

    opens: Moment | None = default(None, "Day or moment from which planners are taken.")
    closes: Moment | None = default(
        None, "Last day, or the moment, until which planners are taken."
    )
    planners: HandedIn = default(
        "any",
        "`sealed`: only planners that were handed in sealed, and that the organisers "
        "ran, are ranked.",
    )
    contact: str = default("", "Whom to ask.", max_length=_TEXT)
    organisers: str = default("", "Who decides.", max_length=_TEXT)
    venue: str = default("", "Where results are presented, such as a conference.", max_length=_TEXT)
    prize: str = default("", "What the best get.", max_length=_TEXT)
    about: str = default(
        "",
        "Text for the challenge's site; an empty line begins a paragraph.",
        max_length=_LONG_TEXT,
    )
    rules: str = default("", "Address of the rules, or the rules in a line.", max_length=_TEXT)

    @model_validator(mode="after")
    def _in_order(self) -> Round:
        if self.opens and self.closes and self.begin >= self.end:
            raise ValueError("a round must close after it opens")
        return self

    @property
    def begin(self) -> datetime:
        """Return the moment from which submissions are accepted."""
        return _at(self.opens, time.min) if self.opens else datetime.min.replace(tzinfo=UTC)

    @property
    def end(self) -> datetime:
        """Return the moment until which submissions are accepted."""
        return _at(self.closes, time.max) if self.closes else datetime.max.replace(tzinfo=UTC)

    def problem(self, moment: datetime) -> str:
        """Return why no submission is accepted at a moment; empty if it is."""
        if moment < self.begin:
            return f"the round opens on {_shown(self.opens)}"
        return f"the round closed on {_shown(self.closes)}" if moment > self.end else ""

    @property
    def mail(self) -> bool:
        """Return True if the contact is an e-mail address."""
        return re.fullmatch(r"[\w.+-]+@[\w-]+(\.[\w-]+)+", self.contact) is not None

    @property
    def paragraphs(self) -> list[str]:
        """Return the paragraphs of the text for the site."""
        return [" ".join(part.split()) for part in re.split(r"\n\s*\n", self.about.strip()) if part]

    @property
    def text(self) -> str:
        """Return a one-line summary of the round."""
        parts = [
            f"opens {_shown(self.opens)}" if self.opens else "",
            f"closes {_shown(self.closes)}" if self.closes else "",
            "sealed planners only" if self.planners == "sealed" else "",
            f"rules: {self.rules}" if self.rules else "",
            f"contact: {self.contact}" if self.contact else "",
            f"organisers: {self.organisers}" if self.organisers else "",
            f"venue: {self.venue}" if self.venue else "",
            f"prize: {self.prize}" if self.prize else "",
        ]
        return ", ".join(part for part in parts if part) or "no dates"


def _shown(text: str | None) -> str:
    """Return a day or a moment with blanks between day, time and zone."""
    return re.sub(r"(?<=\d)(?=[+-]\d\d:?\d\d$)", " UTC", (text or "").replace("T", " "))


def _at(text: str, alone: time) -> datetime:
    """Return the moment of a text; for a day without a time, ``alone`` is the time, UTC."""
    found = datetime.fromisoformat(text)
    return found if found.tzinfo is not None else datetime.combine(found.date(), alone, UTC)
