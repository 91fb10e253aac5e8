"""``crowdbot docs``: crowdbot's documentation, offline."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.errors import InputError, UnknownNameError

#: Characters shown of a line that contains the search text.
_EXCERPT = 120
#: Top pages and folders in the order of the index: tutorials before reference.
_ORDER = (
    "index",
    "tutorial",
    "howto",
    "examples",
    "reference",
    "gallery",
    "explanation",
    "decisions",
    "developers",
)
#: Folders for developers of crowdbot, which a search leaves out unless asked.
_DEVELOPERS = ("decisions/", "developers/")


def docs(
    page: Annotated[str | None, argument("[PAGE]", "Such as howto/score_own_data.")] = None,
    search: Annotated[
        str | None, option("TEXT", "Print the lines of all pages that contain a text.")
    ] = None,
    developers: Annotated[
        bool, switch("--developers", "Also search the pages for crowdbot's developers.")
    ] = False,
    path: Annotated[bool, switch("--path", "Print only where the page is.")] = False,
    as_json: AsJson = False,
) -> None:
    """List the pages of the documentation, print one, or search them. Works offline.

    Example: crowdbot docs howto/score_own_data
    """
    folder = documents()
    if search is not None:
        found = [] if not search.strip() else list(_lines(folder, search, developers))
        shown = [f"{f['page']}:{f['line']}: {_excerpt(str(f['text']), search)}" for f in found]
        say(json.dumps(found, indent=2, ensure_ascii=False) if as_json else "\n".join(shown))
        if not found:
            raise InputError(f"no page holds '{search}'")
        return
    if page is None:
        titles = {name: _title(folder / f"{name}.md") for name in pages(folder)}
        if as_json:
            say_json(titles, ensure_ascii=False)
        else:
            width = max(map(len, titles))
            say("\n".join(f"{n:<{width}}  {t}" for n, t in titles.items()))
        return
    file = _file(folder, page)
    if as_json:
        text = file.read_text(encoding="utf-8")
        say(json.dumps({"path": str(file), "text": text}, ensure_ascii=False))
    else:
        say(str(file) if path else file.read_text(encoding="utf-8").rstrip())


def documents() -> Path:
    """Return the folder of the pages: inside an installed package, else beside it.

    Raises:
        InputError: neither folder exists.
    """
    package = Path(__file__).parents[3]
    for folder in (package / "docs", package.parent / "docs"):
        if (folder / "index.md").is_file():
            return folder
    raise InputError(f"{package}: this installation has no documents")


def pages(folder: Path) -> list[str]:
    """Return the names of all pages: the index first, then folders in its order."""
    names = (f.relative_to(folder).with_suffix("").as_posix() for f in folder.rglob("*.md"))
    return sorted(names, key=_place)


def _place(name: str) -> tuple[int, str]:
    top = name.partition("/")[0]
    return (_ORDER.index(top) if top in _ORDER else len(_ORDER), name)


def _file(folder: Path, page: str) -> Path:
    known = pages(folder)
    name = page.removesuffix(".md").removeprefix("docs/")
    last = [n for n in known if n.rpartition("/")[2] == name]
    if name not in known and len(last) != 1:
        raise UnknownNameError("page", page, [*known, *(n.rpartition("/")[2] for n in known)])
    return folder / f"{name if name in known else last[0]}.md"


def _title(file: Path) -> str:
    with file.open(encoding="utf-8") as lines:
        return next((line[2:].strip() for line in lines if line.startswith("# ")), "")


def _excerpt(line: str, text: str) -> str:
    """Return a line, or the whole words around the match if it is long."""
    if len(line) <= _EXCERPT:
        return line
    at = max(line.casefold().find(text.casefold()), 0)
    begin = max(0, min(at - _EXCERPT // 2, len(line) - _EXCERPT))
    part = line[begin : begin + _EXCERPT]
    before, after = begin > 0, begin + _EXCERPT < len(line)
    part = part.partition(" ")[2] if before and " " in part[: at - begin] else part
    end = part.rpartition(" ")[0] if after else part
    part = end if text.casefold() in end.casefold() else part
    return f"{'… ' if before else ''}{part}{' …' if after else ''}"


def _lines(folder: Path, text: str, developers: bool) -> list[dict[str, object]]:
    needle = text.casefold()
    return [
        {"page": name, "line": number, "text": line.strip()}
        for name in pages(folder)
        if developers or not name.startswith(_DEVELOPERS)
        for number, line in enumerate(
            (folder / f"{name}.md").read_text(encoding="utf-8").splitlines(), 1
        )
        if needle in line.casefold()
    ]
