"""Changes of a scenario's text, which keep its comments, its order and its style."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from crowdbot.errors import InputError

Path = Sequence[str | int]
#: Text of a new document.
NEW = """\
# Drawn with crowdbot edit.
crowdbot: 1
scenario:
  id: {name}
  environment:
    kind: floor
    area: {{x: [0, 20], y: [0, 10]}}
    zones:
      everywhere: {{x: [0, 20], y: [0, 10]}}
"""


class Edit(NamedTuple):
    """One change: a value at a path of keys and indices; None removes what is there."""

    path: Path
    value: Any


def changed(text: str, changes: Sequence[Edit]) -> str:
    """Return a text with changes made to it.

    Raises:
        InputError: the text is not YAML, or a path leads through something that is not a map.
    """
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    yaml = YAML(typ="rt")
    yaml.preserve_quotes = True
    yaml.width = 100
    yaml.indent(mapping=2, sequence=4, offset=2)
    try:
        root = yaml.load(text)
    except YAMLError as error:
        raise InputError(f"the text is not YAML: {str(error).splitlines()[0]}") from None
    if not isinstance(root, Mapping):
        raise InputError("the text has no fields: a scenario begins with 'crowdbot: 1'")
    for change in changes:
        _make(root, list(change.path), change.value)
    stream = io.StringIO()
    yaml.dump(root, stream)
    return stream.getvalue()


def _make(root: Any, path: list[str | int], value: Any) -> None:
    if not path:
        raise InputError("a change does not say which field it changes: its path is missing")
    inherits = "extends" in root or "extends" in (root.get("scenario") or {})
    parent, last = _descend(root, path, create=value is not None or inherits)
    if parent is None:
        return
    if value is None and inherits and isinstance(parent, Mapping):
        kept: Any = parent
        kept[last] = None  # what another file says is removed by null
        return
    if value is not None:
        if isinstance(parent, list):
            if last == len(parent):
                parent.append(_plain(value))
            else:
                parent[int(last)] = _kept(parent[int(last)], value)
        else:
            parent[last] = _kept(parent.get(last), value)
    elif isinstance(parent, list):
        if isinstance(last, int) and last < len(parent):
            del parent[last]
    else:
        parent.pop(last, None)


def _descend(root: Any, path: list[str | int], *, create: bool) -> tuple[Any, Any]:
    """Return the map or list that holds the end of a path, and its key there.

    Keys of documents may be dotted: `robots.robot.task` is found for three keys of a path.
    """
    node: Any = root
    left = path
    while True:
        if isinstance(node, list):
            if not isinstance(left[0], int) or not 0 <= left[0] <= len(node):
                raise InputError(f"no entry {left[0]!r} in a list")
            if len(left) == 1:
                return node, left[0]
            if left[0] == len(node):
                raise InputError(f"no entry {left[0]} in a list")
            node, left = node[left[0]], left[1:]
            continue
        if not isinstance(node, Mapping):
            raise InputError(
                f"'{'.'.join(map(str, path))}' is not a field: a single value comes before it"
            )
        if isinstance(left[0], int):
            raise InputError(f"'{_dotted(path)}': these rows are in a table, which is edited there")
        count = next((n for n in range(len(left), 0, -1) if _dotted(left[:n]) in node), 0)
        if count == len(left):
            return node, _dotted(left)
        if count:
            node, left = node[_dotted(left[:count])], left[count:]
        elif not create:
            return None, ""
        elif len(left) == 1:
            return node, left[0]
        else:
            parent: Any = node
            parent[left[0]] = [] if isinstance(left[1], int) else _map({})
            node, left = parent[left[0]], left[1:]


def _dotted(keys: Sequence[str | int]) -> str:
    return ".".join(map(str, keys))


def _kept(old: Any, value: Any) -> Any:
    """Return a new value in the place of an old one: equal maps keep their style and comments."""
    if isinstance(old, Mapping) and isinstance(value, Mapping):
        kept: Any = old
        for key in [key for key in old if key not in value]:
            del kept[key]
        for key, part in value.items():
            kept[key] = _kept(old.get(key), part)
        return kept
    if isinstance(old, list) and isinstance(value, list) and len(old) == len(value):
        for number, part in enumerate(value):
            old[number] = _kept(old[number], part)
        return old
    return _plain(value)


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return _map({str(key): _plain(part) for key, part in value.items()})
    if isinstance(value, list):
        from ruamel.yaml.comments import CommentedSeq

        found = CommentedSeq([_plain(part) for part in value])
        if not any(isinstance(part, Mapping) for part in value):
            found.fa.set_flow_style()
        return found
    if isinstance(value, float):
        if not math.isfinite(value):
            raise InputError("a number is infinite or not a number")
        rounded = round(value, 6)
        return int(rounded) if rounded == int(rounded) else rounded
    return value


def _map(value: Mapping[str, Any]) -> Any:
    from ruamel.yaml.comments import CommentedMap

    found = CommentedMap(value)
    nested = any(isinstance(part, Mapping) and part for part in value.values())
    if value and (not nested or len(str(dict(value))) < 90):
        found.fa.set_flow_style()
    return found
