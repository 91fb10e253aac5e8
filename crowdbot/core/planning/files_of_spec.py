"""Files that a registered planner reads, such as weights: found, hashed, and known by content."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path, PurePath

from crowdbot.core.support.text_files import suggest_files
from crowdbot.dsl.spec.assets import Asset, sha256_of
from crowdbot.dsl.spec.component_specs import PlannerSpec
from crowdbot.dsl.text.bounded_files import reason_of
from crowdbot.errors import InputError

#: Ending of the names under which files of planners are kept, after their SHA-256.
KEPT = ".weights"


def with_files(spec: PlannerSpec, folders: Mapping[str, Path], kept: Path | None) -> PlannerSpec:
    """Return a spec whose files are found and hashed.

    The spec knows a file by its name and content, so that the same planner has the same hash in
    any folder.

    Args:
        spec: validated.
        folders: folder of the paths in each field; others are relative to the working directory.
        kept: folder of files that are named by their SHA-256, which are taken first; may be None.
            If there is one, the paths are those of someone else, and only their names are used.

    Raises:
        InputError: a file cannot be read, or has another content than its hash says.
    """
    found = {n: _found(spec, n, a, folders.get(n, Path()), kept) for n, a in _assets(spec)}
    return spec.model_copy(update=found) if found else spec


def files_of_spec(spec: PlannerSpec) -> dict[str, Path]:
    """Return SHA-256 -> file of all files that a spec names."""
    return {str(asset.sha256): asset.file for _, asset in _assets(spec)}


def with_absolute_files(spec: PlannerSpec) -> dict[str, dict[str, str]]:
    """Return the fields that name files, with absolute paths, for another process."""
    return {
        name: {"path": str(asset.file.resolve()), "sha256": asset.sha256 or sha256_of(asset.file)}
        for name, asset in _assets(spec)
    }


def _assets(spec: PlannerSpec) -> Iterator[tuple[str, Asset]]:
    return ((name, value) for name, value in vars(spec).items() if isinstance(value, Asset))


def _found(spec: PlannerSpec, field: str, asset: Asset, folder: Path, kept: Path | None) -> Asset:
    name = PurePath(asset.path).name
    if kept is not None and asset.sha256 and (kept / f"{asset.sha256}{KEPT}").is_file():
        file = kept / f"{asset.sha256}{KEPT}"
    else:
        file = folder / (asset.path if kept is None else name)
    where = f"planner '{spec.kind}': {field}: {file}"
    try:
        digest = sha256_of(file)
    except (OSError, ValueError) as error:
        raise InputError(f"{where}: {reason_of(error)}{suggest_files(file)}") from None
    if asset.sha256 not in (None, digest):
        raise InputError(f"{where} does not have the sha256 of its document, but {digest}")
    return Asset.at(file, name, digest)
