"""The files that a planner consists of, as far as they can be found without running it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from crowdbot.core.planning.policies.policy_name import is_policy, policy_file
from crowdbot.core.support.source_digest import data_files, source_files
from crowdbot.dsl.text.plain_document import read_document
from crowdbot.errors import InputError


def planner_files(text: str, include: Iterable[str] = ()) -> dict[str, Path]:
    """Return name -> file of a planner's file, of modules beside it and of other files.

    Args:
        text: ``FILE.py:CLASS``, or the document of a program.
        include: further names or patterns, relative to the planner's folder.

    Raises:
        InputError: there is no such file, or a pattern matches none or leads out of the folder.
    """
    if is_policy(text):
        file = policy_file(text)
        if not file.is_file():
            raise InputError(f"{file}: no such file")
        return {file.name: file}
    path = Path(text.rpartition(":")[0] if ".py:" in text else text)
    if path.suffix not in (".py", ".yaml", ".yml"):
        raise InputError(f"{text}: a planner is handed in as FILE.py:CLASS or as a document")
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    files = {path, *(source_files(path) if path.suffix == ".py" else _of_document(path))}
    folder = path.resolve().parent
    named = {_name(file, folder): file for file in files}
    for name, file in data_files(folder, include).items():
        if name.startswith("../"):
            raise InputError(f"{file} does not lie in {folder}, from which the planner is sealed")
        named[name] = file
    return named


def _of_document(path: Path) -> set[Path]:
    """Return the files that a document names and that lie in its folder."""
    document, folder = read_document(path, str(path)), path.resolve().parent
    if not isinstance(document, dict):
        raise InputError(f"{path}: a file of a planner has fields, such as 'kind: dwa'")
    words = document.get("command") or [document.get("python")]
    named = [folder / w for w in words if isinstance(w, str)] if isinstance(words, list) else []
    found = {file for file in named if file.is_file() and file.resolve().is_relative_to(folder)}
    planner = str(document.get("planner", "")).rpartition(":")[0]
    for file in [*found, folder / planner]:
        if file.suffix == ".py" and file.is_file():
            found |= source_files(file)
    patterns = document.get("files") or []
    return found | set(data_files(folder, [str(p) for p in patterns]).values())


def _name(file: Path, folder: Path) -> str:
    place = file.parent.resolve() / file.name
    if not place.is_relative_to(folder):
        raise InputError(f"{file} does not lie in {folder}, from which the planner is sealed")
    return place.relative_to(folder).as_posix()
