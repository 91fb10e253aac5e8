"""The questionnaires NASA-TLX and USE: their questions and valid answers.

NASA-TLX: Hart, Staveland, "Development of NASA-TLX", 1988; its text is in the public domain, and is
paraphrased here. USE: Lund, "Measuring usability with the USE questionnaire", 2001; items are
paraphrased, a study names a file with the original wording.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from crowdbot.core.studies.document import Study
from crowdbot.core.support.text_files import input_text
from crowdbot.core.trajectories.questionnaires import TLX_SCALES, USE_ITEMS
from crowdbot.errors import InputError

#: Ratings of NASA-TLX: 21 marks.
TLX_MARKS = tuple(range(0, 101, 5))
#: Scale -> title, question, and its two ends.
TLX_WORDS = {
    "mental_demand": (
        "Mental demand", "How much did you have to think, decide and look?", "low", "high",
    ),
    "physical_demand": (
        "Physical demand", "How much bodily effort did it take?", "low", "high",
    ),
    "temporal_demand": (
        "Temporal demand", "How hurried was the pace?", "low", "high",
    ),
    "performance": (
        "Performance", "How well did you do what you were asked to do?", "perfectly", "not at all",
    ),
    "effort": (
        "Effort", "How hard did you have to work for it?", "little", "much",
    ),
    "frustration": (
        "Frustration", "How irritated, stressed or discouraged were you?", "little", "much",
    ),
}  # fmt: skip
#: Marks of USE.
USE_MARKS = tuple(range(1, 8))
#: Dimension -> its items in our words.
USE_WORDS = {
    "usefulness": (
        "It makes me more effective.", "It makes me get more done.", "It is of use to me.",
        "I am more in control of what I do with it.", "With it my tasks are less work.",
        "It spares me time.", "It does what I need.", "It does all that I would expect.",
    ),
    "ease_of_use": (
        "It is easy to drive.", "Driving it is simple.", "It suits its users.",
        "Few steps lead to what I want.", "It adapts to different situations.",
        "It costs no effort.", "I need no written instructions.",
        "I notice no contradictions while I drive.",
        "People who drive seldom or often would like it.",
        "Mistakes are undone quickly and easily.", "It works each time.",
    ),
    "ease_of_learning": (
        "I learnt it quickly.", "I remember easily how it is driven.", "Learning it is easy.",
        "I became skilled with it soon.",
    ),
    "satisfaction": (
        "I am content with it.", "I would recommend it to friends.", "It is fun.",
        "It works as I want it to.", "It is delightful.", "I feel that I need one.",
        "It is pleasant.",
    ),
}  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    """One question with a rating scale.

    Attributes:
        name: of the answer, as in tables of answers.
        title: short name, or the statement.
        text: the question; may be empty.
        marks: values and their labels, in order.
        ends: words for both ends of the scale; empty for a choice.
        optional: True if it may stay unanswered.
    """

    name: str
    title: str
    text: str = ""
    marks: Sequence[tuple[str, str]] = ()
    ends: tuple[str, str] = ("", "")
    optional: bool = False


def tlx_questions() -> list[Question]:
    """Return the six ratings."""
    marks = [(str(m), str(m)) for m in TLX_MARKS]
    return [
        Question(name=name, title=title, text=text, marks=marks, ends=(low, high))
        for name, (title, text, low, high) in TLX_WORDS.items()
    ]


def weight_questions() -> list[Question]:
    """Return the 15 comparisons of two scales."""
    return [
        Question(
            name=f"pair_{a}_{b}",
            title=f"{TLX_WORDS[a][0]} or {TLX_WORDS[b][0].lower()}?",
            marks=[(a, TLX_WORDS[a][0]), (b, TLX_WORDS[b][0])],
        )
        for a, b in combinations(TLX_SCALES, 2)
    ]


def use_questions(study: Study) -> list[Question]:
    """Return the 30 statements, in the wording of the study.

    Raises:
        InputError: the file with the wording cannot be read, or has another number of lines.
    """
    lines = [text for texts in USE_WORDS.values() for text in texts]
    if study.spec.use_wording:
        path = study.path.parent / study.spec.use_wording
        lines = [line.strip() for line in input_text(path).splitlines() if line.strip()]
        if len(lines) != sum(USE_ITEMS.values()):
            raise InputError(f"{path}: {len(lines)} lines; USE has {sum(USE_ITEMS.values())} items")
    names = [f"{d}_{k}" for d, count in USE_ITEMS.items() for k in range(1, count + 1)]
    marks = [("", "does not apply"), *((str(m), str(m)) for m in USE_MARKS)]
    return [
        Question(name=name, title=text, marks=marks, optional=True,
                 ends=("I disagree strongly", "I agree strongly"))
        for name, text in zip(names, lines, strict=True)
    ]  # fmt: skip


def questions_of(kind: str, study: Study) -> list[Question]:
    """Return the questions of a form: ``nasa_tlx``, ``weights`` or ``use``."""
    if kind == "use":
        return use_questions(study)
    return tlx_questions() if kind == "nasa_tlx" else weight_questions()


def checked_answers(
    questions: Sequence[Question], given: Mapping[str, str]
) -> tuple[dict[str, str], list[str]]:
    """Return the answers by name, and the names of unanswered or invalid questions."""
    answers, open_ones = {}, []
    for question in questions:
        value = given.get(question.name)
        if value is None or value not in {mark for mark, _ in question.marks}:
            open_ones.append(question.name)
        else:
            answers[question.name] = value
    return answers, open_ones


def weights_of(answers: Mapping[str, str]) -> dict[str, float]:
    """Return how often each scale was chosen in the comparisons."""
    return {scale: float(list(answers.values()).count(scale)) for scale in TLX_SCALES}
