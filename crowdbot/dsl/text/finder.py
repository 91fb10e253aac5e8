"""Find files named in documents: beside the document or in a plugin's folder.

Nothing outside the top-level file's folder and the packaged folders is ever read.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath, PureWindowsPath

from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.errors import did_you_mean, nearest

#: Plugin name -> its folders with suites and parts.
Roots = Mapping[str, Sequence[Path]]


@dataclass(frozen=True, slots=True)
class Finder:
    """Allowed locations of one document's files.

    Attributes:
        top: the top-level file.
        roots: packaged folders.
    """

    top: Path
    roots: Roots

    def find(self, text: str, mark: Mark) -> Path | Diagnostic:
        """Return the file of a path, if it may be read; otherwise the error.

        Args:
            text: a path relative to the file that contains it, or ``NAME:path``.
            mark: its position; ``--set`` counts as the top-level file.
        """
        prefix, colon, rest = text.rpartition(":")
        if PurePosixPath(rest).is_absolute() or PureWindowsPath(text).drive or "\0" in text:
            name = PureWindowsPath(text.replace("\0", "")).name
            hint = f"copy it beside {self.top.name} and write '{name}'" if name else ""
            return Diagnostic("E203", f"'{text}' is not a relative path", mark, hint)
        if colon and prefix not in self.roots:
            hint = did_you_mean(nearest(prefix, self.roots)).removeprefix("; ")
            hint = hint or f"is the package providing '{prefix}' installed?"
            return Diagnostic("E201", f"no plugin '{prefix}' with scenario files", mark, hint)
        folders = self.roots[prefix] if colon else [(mark.source.file or self.top).parent]
        try:
            path = next((f / rest for f in folders if (f / rest).exists()), folders[0] / rest)
            allowed, exists = self._allowed(path), path.exists()
        except (OSError, RuntimeError) as error:  # name too long, or circular links
            reason = getattr(error, "strerror", None) or str(error)
            return Diagnostic("E201", f"'{text[:60]}' cannot be opened: {reason}", mark)
        if not allowed:
            hint = f"files lie beside or below {self.top.name}, or in a plugin's folder"
            text = f"'{text}' leaves the folder of {self.top.name}"
            return Diagnostic("E203", text, mark, hint)
        if not exists:
            return Diagnostic("E201", f"no file '{text}'", mark, _similar(path))
        return path

    def name_of(self, file: Path) -> str:
        """Return the path that names a found file when written in the top-level file."""
        target = file.resolve()
        own = {"": [self.top.parent]} | {f"{name}:": fs for name, fs in self.roots.items()}
        for prefix, folders in own.items():
            for folder in folders:
                if target.is_relative_to(folder.resolve()):
                    return prefix + target.relative_to(folder.resolve()).as_posix()
        return str(target)

    def _allowed(self, path: Path) -> bool:
        allowed = [self.top.parent, *(f for fs in self.roots.values() for f in fs)]
        target = path.resolve()
        return any(target.is_relative_to(folder.resolve()) for folder in allowed)


def _similar(path: Path) -> str:
    names = (p.name for p in path.parent.iterdir()) if path.parent.is_dir() else ()
    return did_you_mean(nearest(path.name, names)).removeprefix("; ")
