"""Check and write imported documents; errors name the position in the imported file."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from crowdbot.core.exchange.scene import Draft
from crowdbot.core.exchange.write import WrittenLine
from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.dsl.text.bounded_files import MAX_BYTES
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.errors import SpecError


def check(
    lines: Sequence[WrittenLine], scenes: Sequence[Draft], registry: Registry, default: Mark
) -> list[str]:
    """Validate an imported document like any other; return the ids of its scenarios.

    Args:
        lines: the document.
        scenes: those that its lines name.
        registry: the installed components.
        default: position for errors that have no origin in the files.

    Raises:
        SpecError: E402, what the files say is not a valid scenario, or is too large for one file.
    """
    _check_size(lines, len(scenes), default)
    with tempfile.TemporaryDirectory(prefix="crowdbot-import-") as folder:
        path = Path(folder) / "imported.yaml"
        write(path, lines, scenes)
        try:
            return [scenario.id for scenario in open_spec(str(path), registry).scenarios]
        except SpecError as error:
            found = [_at_origin(d, path, lines, scenes, default) for d in error.diagnostics]
            raise SpecError(list({d.sort_key(): d for d in found}.values())) from None


def _check_size(lines: Sequence[WrittenLine], scenes: int, default: Mark) -> None:
    size = sum(len(line.text.encode()) + 1 for line in lines)
    if size > MAX_BYTES:
        message = f"{scenes} scenarios make a document of {size / 1e6:.1f} MB"
        hint = f"it may have {MAX_BYTES / 1e6:g} MB: give fewer files in one command"
        raise SpecError([Diagnostic("E402", message, default, hint)])


def write(path: Path, lines: Sequence[WrittenLine], scenes: Sequence[Draft]) -> list[Path]:
    """Write a document and the tables beside it; return the files."""
    tables: Mapping[str, str] = {n: t for scene in scenes for n, t in scene.tables.items()}
    files = [path.with_name(name) for name in tables]
    for file, content in zip(files, tables.values(), strict=True):
        atomic_write(file, content)
    atomic_write(path, "".join(f"{line.text}\n" for line in lines))
    return [path, *files]


def _at_origin(
    diagnostic: Diagnostic,
    path: Path,
    lines: Sequence[WrittenLine],
    scenes: Sequence[Draft],
    default: Mark,
) -> Diagnostic:
    """Return an error of our document as one of the file that it came from."""
    mark = default
    if diagnostic.mark.source.file == path or diagnostic.mark.source.name == str(path):
        line = lines[min(diagnostic.mark.line, len(lines) - 1)]
        if line.scene >= 0:
            mark = _origin(line, scenes[line.scene], default)
    message = f"as imported: {diagnostic.message}"
    hint = diagnostic.hint if diagnostic.hint else f"in our words {diagnostic.code}"
    return Diagnostic("E402", message, mark, hint)


def _origin(line: WrittenLine, scene: Draft, default: Mark) -> Mark:
    for length in range(len(line.path), 0, -1):
        if line.path[:length] in scene.origins:
            return scene.origins[line.path[:length]]
    first = next(iter(scene.origins.values()), default)
    return scene.origins.get((), first)
