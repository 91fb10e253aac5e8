"""Finds retired words; what each thing is called is in docs/developers/glossary.md.

    python scripts/check_vocabulary.py [FILE...]

Prints ``file:line: text -> what to write`` and ends with exit code 1 if there are any. Only words
that have no other meaning here are listed: this finds renamed terms, and prose that is hard to read
in the pages and in docstrings, comments and messages of the package (`PLAIN`). It is not a style
guide.
"""

from __future__ import annotations

import io
import re
import sys
import tokenize
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
#: Folders, searched recursively, and files.
PLACES = ("crowdbot", "docs", "tests", "README.md", "CONTRIBUTING.md")
#: Files that have to name retired words.
EXEMPT = ("tests/test_check_vocabulary.py", "scripts/check_vocabulary.py")
CODE, TEXT = (".py", ".js", ".j2", ".tmpl"), (".md", ".txt", ".yaml", ".toml")
EVERYWHERE = CODE + TEXT
#: Folders and files whose code and pages are also checked with `PLAIN`.
PLAIN_PLACES = ("crowdbot", "docs", "README.md", "CONTRIBUTING.md")
_BEFORE = 40  # characters that `Rule.unless` sees


class Rule(NamedTuple):
    """A retired word or phrase.

    Attributes:
        pattern: regular expression.
        instead: replacement.
        suffixes: suffixes of the files to search.
        unless: regular expression for preceding text that makes it right.
    """

    pattern: str
    instead: str
    suffixes: Sequence[str] = EVERYWHERE
    unless: str = ""


_COMPARED = (
    "longer|farther|further|better|worse|more|less|fewer|larger|smaller|bigger|greater|nearer|"
    "closer|wider|higher|lower|later|earlier|sooner|faster|slower|shorter|harder|easier|stricter|"
    "different|older|newer|one"
)

RULES = (
    Rule(r"\b(?:write_aside|writ\w+ (?:\w+ ){0,2}aside|aside,? (?:and|first|then) renam\w+)\b",
         "atomic_write; write under a temporary name, then rename"),
    Rule(r"\b[Ww]illed\b", "desired acceleration"),
    Rule(r"\b[Cc]omparands?\b", "DiffSide, diff side"),
    Rule(r"\b[Ll]eash(?:es)?\b", "clearance cache"),
    Rule(r"\b[Cc]hatter\b", "stdout guard, stdout_to_stderr", (".md",)),
    Rule(r"\b[Ww]orkshops?\b", "executor, execute"),
    Rule(r"\b(?:[Cc]rews?|(?:Local|Cluster)Crew)\b", "worker pool"),
    Rule(r"\b[Ee]ntrants?\b", "planner entry"),
    Rule(r"\b(?i:deeds?)\b", "build function"),
    Rule(r"\b[Ll]aws\b", "invariants"),
    Rule(r"\bsame(?:_|\s+)words\b", "same spec"),
    Rule(r"\b[Uu]nsteady\b", "nondeterministic"),
    Rule(r"\bin_turn\b", "entry_order", CODE),
    Rule(r"\bunder_way\b", "active", CODE),
    Rule(r"\bPhotographs?\b", "CameraFrame"),
    Rule(r"\b(?:[Pp]ainter|paint_depth)\b", "ColourRenderer, render_depth", CODE),
    Rule(r"\b(?:fault\.described|is_users)\b", "describe_error, is_user_interrupt"),
    Rule(r"\b(?:Foxglove|Zenoh|Page)?Doors?\b|\b_doors\b", "LiveConnection, server", CODE,
         unless=r"\""),
    Rule(r"\bManner\b", "StepPolicy", CODE),
    Rule(r"\bWishes\b", "SubscriptionOptions", CODE),
    Rule(r"\bFate\b", "PartOutcome, RobotEnding", CODE),
    Rule(r"\bclass Way\b|\bway_build\b", "PathFinder", CODE),
    Rule(r"\b(?:seldom_collected|collect_seldom|collected_as_usual)\b",
         "throttled_gc, throttle_gc, usual_gc", CODE),
    Rule(r"\b(?:_add_mind|laid_over|quick_exit|aim_of)\b",
         "_add_sensors_and_planner, path_overlay, skip_final_gc, goal_column_of", CODE),
    Rule(r"\b_?(?:told|said)(?: [:|+]?= |: (?:str|bool|Any|Mapping|dict|list)\b)",
         "message, text, answer, description, or what it holds", CODE),
    Rule(rf"\b(?:is|are|was|were)\s+no\b(?!\s+(?:{_COMPARED})\b)(?!-)", "is not a, is not an",
         unless=r"\b[Tt]here\s+"),
    Rule(r"\b(?:is|are)\s+none\b(?!\s+of)", "is not one, has none", unless=r"\b[Tt]here\s+"),
)  # fmt: skip

#: Rules for pages, and for docstrings, comments and other strings of Python files.
PLAIN = (
    Rule(r'(?m)^[ \t]*r?"""(?:What|How|Who|Whom|Whose|Where|When|Whether|Why|Which|Of)\b',
         "say what it is, or what it does: 'Return True if …'", (".py",)),
    Rule(r"#:?\s(?:Of|Whether)\b", "say what it is", (".py",)),
    Rule(r"\b(?i:nobody|somebody|whoever)\b", "no one, a person, it",
         unless=r"\bavoid[ _]|\""),
    Rule(r"\b(?i:everybody|anybody)\b", "everyone, anyone, all people", (".md",)),
    Rule(r"\banew\b", "again, new"),
    Rule(r"\b[Ss]o many\b", "this many"),
    Rule(r"\b[Ff]or ever\b", "forever, without limit"),
    Rule(r"\bway made good\b", "progress"),
    Rule(r"\b(?:he|his|him|she|her)\b", "it, the person"),
)  # fmt: skip


def files_to_read() -> Iterator[Path]:
    """Yield all texts below `PLACES`."""
    for name in PLACES:
        place = ROOT / name
        for file in sorted(place.rglob("*")) if place.is_dir() else [place]:
            if file.name.endswith(".min.js"):
                continue  # of others
            if file.suffix in EVERYWHERE and file.relative_to(ROOT).as_posix() not in EXEMPT:
                yield file


def findings(
    text: str, suffix: str, rules: Sequence[Rule] = RULES
) -> Iterator[tuple[int, str, str]]:
    """Yield line, text and replacement of each retired word.

    Args:
        text: contents of a file.
        suffix: suffix of its name, which selects the rules.
        rules: rules to apply.
    """
    for rule in rules:
        if suffix not in rule.suffixes:
            continue
        for found in matches(rule.pattern, text):
            before = text[max(0, found.start() - _BEFORE) : found.start()]
            if rule.unless and re.search(rf"(?:{rule.unless})\Z", before):
                continue
            line = text.count("\n", 0, found.start()) + 1
            yield line, " ".join(found[0].split()), rule.instead


def matches(pattern: str, text: str) -> Iterator[re.Match[str]]:
    r"""Yield what `re.finditer` would, for a pattern that has at most one ``\b`` in front.

    With that left out, and looked for where the rest is found, it takes a tenth of the time.
    """
    word = pattern.startswith(r"\b")
    rest, place = re.compile(pattern.removeprefix(r"\b")), 0
    while found := rest.search(text, place):
        inside = word and found.start() > 0 and re.match(r"\w", text[found.start() - 1])
        place = found.start() + 1 if inside else found.end()
        if not inside:
            yield found


def prose(code: str) -> str:
    """Return Python code with everything but comments and strings blanked."""
    kept = [" " * len(line.rstrip("\n")) for line in code.splitlines()]
    lines = code.splitlines()
    for token in tokenize.generate_tokens(io.StringIO(code).readline):
        if tokenize.tok_name[token.type] not in ("STRING", "COMMENT", "FSTRING_MIDDLE"):
            continue
        (first, begin), (last, end) = token.start, token.end
        for number in range(first, last + 1):
            a = begin if number == first else 0
            b = end if number == last else len(lines[number - 1])
            line = kept[number - 1]
            kept[number - 1] = line[:a] + lines[number - 1][a:b] + line[b:]
    return "\n".join(kept)


def is_plain_place(file: Path) -> bool:
    """Return True if a file is checked with `PLAIN`."""
    if file.suffix not in (".py", ".md", ".js", ".j2") or not file.is_relative_to(ROOT):
        return False
    name = file.relative_to(ROOT).as_posix()
    return any(name == place or name.startswith(f"{place}/") for place in PLAIN_PLACES)


def main(arguments: Sequence[str]) -> int:
    """Check the named files, or all; return the exit code."""
    found = 0
    for file in map(Path, arguments) if arguments else files_to_read():
        content = file.read_text("utf-8", errors="replace")
        all_findings = list(findings(content, file.suffix))
        if is_plain_place(file.resolve()):
            plain = list(findings(content, file.suffix, PLAIN))
            if plain and file.suffix == ".py":  # not before: it takes longer than all rules
                plain = list(findings(prose(content), file.suffix, PLAIN))
            all_findings += plain
        for line, text, instead in sorted(all_findings):
            place = file.relative_to(ROOT) if file.is_relative_to(ROOT) else file
            print(f"{place}:{line}: {text} -> {instead}")
            found += 1
    return int(found > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
