"""Read a YAML file into a model, with the bounds and positions of all documents."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel

from crowdbot.dsl.checks.pydantic_errors import validate
from crowdbot.dsl.text.bounded_files import read_text
from crowdbot.dsl.text.diagnostics import Diagnostic, Source
from crowdbot.dsl.text.nodes import Node, parse
from crowdbot.dsl.text.plain_document import plain
from crowdbot.errors import SpecError

M = TypeVar("M", bound=BaseModel)


def read_model(path: Path, model: type[M]) -> tuple[M, Node]:
    """Return the model of a file, and its tree for the positions of further errors.

    Maps keep the order of the file.

    Raises:
        SpecError: it cannot be read, is not plain YAML, or does not fit the model.
    """
    text = read_text(path, str(path))
    problems: list[Diagnostic] = []
    tree = parse(text, Source(str(path), text.split("\n"), file=path), problems)
    if problems:
        raise SpecError(problems)
    made, problems = validate(model, plain(tree), tree)
    if made is None:
        raise SpecError(problems)
    return made, tree
