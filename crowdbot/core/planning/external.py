"""Planners in another Python or language: documents with ``python`` or ``command``."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

from crowdbot.core.planning.choice import PlannerChoice, PlannerPlace, label_of
from crowdbot.core.planning.containment.declared import needs_of_program
from crowdbot.core.planning.guarded import planner_title
from crowdbot.core.planning.process import foreign_main
from crowdbot.core.planning.process.describe import describe
from crowdbot.core.planning.process.process_plan import ProcessPlan
from crowdbot.core.planning.unchanged_files import while_unchanged
from crowdbot.core.support.source_digest import (
    data_files,
    digest_of_files,
    file_digest,
    source_digest,
    source_files,
)
from crowdbot.errors import InputError, did_you_mean, nearest

_FIELDS = (
    "command", "python", "planner", "name", "parameters", "files", "libraries", "network",
)  # fmt: skip
#: Files of crowdbot that run in another Python.
_FOREIGN_SIDE = ("foreign_main.py", "serving.py", "small_msgpack.py")
_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}")


def is_external(document: Mapping[str, Any]) -> bool:
    """Return True if a planner's document names a program rather than a kind."""
    return "kind" not in document and any(name in document for name in ("command", "python"))


def external_choice(
    path: Path, document: Mapping[str, Any], settings: Mapping[str, Any], place: PlannerPlace
) -> PlannerChoice:
    """Return the planner of a document that names a program.

    Args:
        path: path of the document; file names are relative to its folder.
        document: the document's contents.
        settings: parameters that override those of the document.
        place: where it runs; it cannot be the simulator's process.

    Raises:
        InputError: the document is wrong.
        PlannerError: the program does not start or does not reply.
    """
    if place.in_process:
        raise InputError(f"{path}: another program cannot run in the simulator's process")
    program = _Program(path, document)
    parameters = {**program.parameters, **settings}
    description, build = describe(program.process(parameters, place), lenient=place.lenient)
    dump: dict[str, Any] = {
        "kind": f"{path.name}:{program.name}",
        "sha256": program.sha256,
        **({"data": _data(path.resolve().parent, description.data)} if description.data else {}),
        **({"runtime": description.runtime} if description.runtime else {}),
        **({"parameters": parameters} if parameters else {}),
        **({"network": True} if program.needs.network else {}),
    }
    return PlannerChoice(
        name=program.name,
        spec_dump=dump,
        build=while_unchanged(
            build, lambda: _Program(path, document).sha256, program.sha256, str(path)
        ),
        pinned=False,
        origin=str(path),
        needs=description.needs,
        label=label_of(program.name, parameters, description.privileged),
        privileged=description.privileged,
        role="candidate" if parameters else description.role,
        in_process=False,
        memory=place.memory,
    )


class _Program:
    """The contents of a document, checked.

    Attributes:
        name: name of the planner.
        command: command line; the first word is a program's absolute path.
        sha256: hash of the command line and of every file in it.
        needs: what it may read, and if it may use the network.
    """

    def __init__(self, path: Path, document: Mapping[str, Any]) -> None:
        self._path, self._document = path, document
        self._folder = path.resolve().parent
        for field in document:
            if field not in _FIELDS:
                self._fail(
                    f"a program has no field '{field}'{did_you_mean(nearest(field, _FIELDS))}"
                )
        if ("command" in document) == ("python" in document):
            self._fail("give 'command', or 'python' and 'planner'")
        self.parameters = self._mapping()
        files = dict(self._named_files())
        if "command" in document:
            words = self._words("command")
            self.name = str(document.get("name", path.stem))
            if "planner" in document:
                self._fail("'planner' goes with 'python'; a command names its program itself")
            files |= {w: self._folder / w for w in words if (self._folder / w).is_file()}
            self.command: Sequence[str] = [self._found(words[0]), *words[1:]]
        else:
            words, file, name = self._python()
            self.name = str(document.get("name", name))
            self.command = [words[0], str(Path(foreign_main.__file__).resolve()), str(file), name]
            files[file.name] = file
        if not _NAME.fullmatch(self.name):
            self._fail(f"'{self.name}' cannot be a planner's name: letters, digits, '_', '-', '.'")
        self.sha256 = _digest(words if "command" in document else [], files)
        sources = {one for file in files.values() for one in _sources(file)}
        if "python" in document:
            here = Path(foreign_main.__file__).parent
            sources |= {here / name for name in _FOREIGN_SIDE}
        self.needs = needs_of_program(
            Path(self.command[0]), sources, self._libraries(), network=self._network()
        )

    def process(self, parameters: Mapping[str, Any], place: PlannerPlace) -> ProcessPlan:
        """Return the process in which it runs."""
        return ProcessPlan(
            title=planner_title(self.name, str(self._path)),
            command=self.command,
            folder=str(self._folder),
            parameters=parameters,
            memory=place.memory,
            contained=place.contained,
            sealed=place.sealed,
            needs=self.needs,
            beside=self._folder,
        )

    def _mapping(self) -> dict[str, Any]:
        given = self._document.get("parameters", {})
        if not isinstance(given, dict) or not all(isinstance(k, str) for k in given):
            self._fail("'parameters' is a mapping with names")
        return dict(given)

    def _words(self, field: str) -> list[str]:
        words = self._document[field]
        if not isinstance(words, list) or not words or not all(isinstance(w, str) for w in words):
            self._fail(f"'{field}' is a list of words, such as [./my_planner, --fast]")
        return list(words)

    def _python(self) -> tuple[list[str], Path, str]:
        """Return the interpreter, the file and the class."""
        python, planner = self._document["python"], self._document.get("planner")
        if not isinstance(python, str) or not isinstance(planner, str):
            self._fail("'python' is the path of an interpreter, and 'planner' is FILE.py:CLASS")
        file, colon, name = planner.rpartition(":")
        if not colon or not name.isidentifier():
            self._fail(f"planner '{planner}': write FILE.py:CLASS")
        found = self._folder / file
        if not found.is_file():
            self._fail(f"planner '{planner}': {found}: no such file")
        return [self._found(python)], found, name

    def _found(self, program: str) -> str:
        """Return a program in the folder or on the search path."""
        here = self._folder / Path(program).expanduser()
        if ("/" in program) and here.is_file():
            return str(here)
        elsewhere = None if "/" in program else shutil.which(program)
        if elsewhere is None:
            self._fail(
                f"no program '{program}'" + (f" in {self._folder}" if "/" in program else "")
            )
        return elsewhere

    def _named_files(self) -> Iterator[tuple[str, Path]]:
        patterns = self._words("files") if "files" in self._document else []
        for pattern in patterns:
            if not pattern.strip("/. ") or Path(pattern).is_absolute() or ".." in pattern:
                self._fail(f"files: '{pattern}' is not a name or pattern in {self._folder}")
            found = [p for p in sorted(self._folder.glob(pattern)) if p.is_file()]
            if not found:
                self._fail(f"files: nothing in {self._folder} fits '{pattern}'")
            yield from ((p.relative_to(self._folder).as_posix(), p) for p in found)

    def _libraries(self) -> list[Path]:
        words = self._words("libraries") if "libraries" in self._document else []
        folders = [self._folder / Path(word).expanduser() for word in words]
        for word, folder in zip(words, folders, strict=True):
            if not folder.exists():
                self._fail(f"libraries: no folder or file '{word}'")
        return [folder.resolve() for folder in folders]

    def _network(self) -> bool:
        found = self._document.get("network", False)
        if not isinstance(found, bool):
            self._fail("'network' is true or false")
        return found

    def _fail(self, problem: str) -> NoReturn:
        raise InputError(f"{self._path}: {problem}")


def _digest(words: Sequence[str], files: Mapping[str, Path]) -> str:
    """Return the SHA-256 of words and files, independent of the files' location."""
    named = {name: _file_digest(path) for name, path in sorted(files.items())}
    text = json.dumps({"command": list(words), "files": named}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _data(folder: Path, names: Sequence[str]) -> str:
    """Return the SHA-256 of the files that a planner declares as data."""
    return digest_of_files(data_files(folder, names))


def _sources(path: Path) -> set[Path]:
    """Return a file, and modules beside it that it imports."""
    return source_files(path) if path.suffix == ".py" else {path}


def _file_digest(path: Path) -> str:
    if path.suffix == ".py":
        return source_digest(path)
    return file_digest(path)
