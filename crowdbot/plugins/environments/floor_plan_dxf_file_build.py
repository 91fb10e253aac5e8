"""Open DXF drawings, and iterate over their entities, including those of inserted blocks."""

from __future__ import annotations

import io
import logging
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from crowdbot.plugin import InputError
from crowdbot.plugin.for_environments import input_bytes

#: Entities that are read, with those of blocks each time they are inserted.
_MOST_ENTITIES = 200_000
_BINARY, _DWG = b"AutoCAD Binary DXF", re.compile(rb"AC1[0-9]{3}[^\r\n]")
#: The first version of DXF whose texts are UTF-8, 2007.
_IN_UTF8 = "AC1021"
_CONTROL = re.compile(r"[^\x20-\x7e]+")


def opened(file: Path, most: int) -> Any:
    """Return a drawing of ezdxf.

    Args:
        file: ASCII or binary DXF.
        most: largest size, bytes.

    Raises:
        InputError: it is not a drawing, or ezdxf is not installed.
    """
    content = input_bytes(file, most, file.name)
    try:
        from ezdxf.filemanagement import read
    except ImportError as error:
        raise InputError(
            f"{file.name}: reading DXF needs ezdxf; install it with pip install 'crowdbot[dxf]'"
        ) from error
    if _DWG.match(content):
        raise InputError(f"{file.name}: is a DWG drawing; save it as DXF in the CAD program")
    logging.getLogger("ezdxf").setLevel(logging.CRITICAL)
    try:
        return (
            _binary(content) if content.startswith(_BINARY) else read(io.StringIO(_text(content)))
        )
    except Exception as error:  # ezdxf raises many types for damaged drawings
        why = " ".join(_CONTROL.sub(" ", str(error)).split())
        why = why.removeprefix("DXFStructureError: ")[:120] or type(error).__name__
        raise InputError(
            f"{file.name}: is not a DXF drawing, or is cut off or damaged: {why}"
        ) from error


def _binary(content: bytes) -> Any:
    from ezdxf.document import Drawing
    from ezdxf.lldxf.tagger import binary_tags_loader

    return Drawing.load(binary_tags_loader(content, errors="surrogateescape"))


def _text(content: bytes) -> str:
    """Return the text of an ASCII drawing: UTF-8, or before 2007 in the code page it names."""
    from ezdxf.filemanagement import dxf_stream_info

    whole = content.replace(b"\r\n", b"\n").replace(b"\r", b"\n").lstrip(b"\n")
    try:
        return whole.decode("utf-8-sig")
    except UnicodeDecodeError:
        info = dxf_stream_info(io.StringIO(whole.decode("latin-1")))
        encoding = "cp1252" if info.version >= _IN_UTF8 else info.encoding
        return whole.decode(encoding, errors="replace")


def hidden(drawing: Any, layer: str, *, frozen_only: bool = False) -> bool:
    """Return True if a layer is off or frozen; on request, only if it is frozen."""
    if layer not in drawing.layers:
        return False
    state = drawing.layers.get(layer)
    return bool(state.is_frozen() or (state.is_off() and not frozen_only))


def entities(drawing: Any, name: str, aside: Counter[str]) -> Iterator[Any]:
    """Yield the entities of the model space, including those of inserted blocks.

    Args:
        name: of the file, for messages.
        aside: counts what is left out.

    Raises:
        InputError: there are too many, or blocks contain each other.
    """
    walk = _Walk(drawing, name, aside)
    yield from walk.through(drawing.modelspace(), ())
    papers = [paper for paper in drawing.layouts if paper.name != "Model"]
    sheets = sum(e.dxftype() != "VIEWPORT" for paper in papers for e in paper)
    if sheets:
        aside["in the paper space (sheets to print)"] += sheets


class _Walk:
    """Recursive iteration over a drawing's entities."""

    def __init__(self, drawing: Any, name: str, aside: Counter[str]) -> None:
        self._drawing, self._name, self._aside = drawing, name, aside
        self._count = 0

    def through(self, found: Iterable[Any], inside: tuple[str, ...]) -> Iterator[Any]:
        """Yield entities; ``inside``: the names of the blocks that they are in."""
        for entity in found:
            self._count += 1
            if self._count > _MOST_ENTITIES:
                raise InputError(
                    f"{self._name}: more than {_MOST_ENTITIES} entities, blocks included"
                )
            if not entity.dxf.is_supported("invisible"):  # of a kind that ezdxf does not know
                self._aside[f"{_name(entity)} entities"] += 1
            elif entity.dxf.get("invisible", 0):
                self._aside[f"invisible {entity.dxftype()} entities"] += 1
            elif entity.dxftype() == "INSERT":
                yield from self._inserted(entity, inside)
            elif entity.dxftype() == "MLINE":
                yield from self.through(entity.virtual_entities(), inside)
            else:
                yield entity

    def _inserted(self, insert: Any, inside: tuple[str, ...]) -> Iterator[Any]:
        """Yield the entities of a block where it is inserted."""
        block, layer = str(insert.dxf.get("name", "")), str(insert.dxf.layer)
        content = self._drawing.blocks.get(block)
        if content is None:
            self._aside[f"inserted block '{block}', which is not in the file"] += 1
        elif content.block.is_xref or content.block.is_xref_overlay:
            self._aside[f"other drawing '{block}', which it refers to"] += 1
        elif hidden(self._drawing, layer, frozen_only=True):
            self._aside[f"block '{block}' on layer '{layer}', which is frozen"] += 1
        elif block.lower() in inside:
            raise InputError(f"{self._name}: its blocks contain each other: '{block}'")
        else:
            self._aside.update(f"{text.dxftype()} entities" for text in insert.attribs)
            for one in insert.multi_insert() if insert.mcount > 1 else (insert,):
                parts = one.virtual_entities(skipped_entity_callback=self._skipped)
                yield from self.through(_on(parts, layer), (*inside, block.lower()))

    def _skipped(self, entity: Any, reason: str) -> None:
        del reason
        self._aside[f"{entity.dxftype()} entities in blocks"] += 1


def _name(entity: Any) -> str:
    """Return the kind of an entity without characters that are not shown."""
    return _CONTROL.sub("?", entity.dxftype())[:40] or "nameless"


def _on(parts: Iterable[Any], layer: str) -> Iterator[Any]:
    """Yield the copied entities of a block; those on layer 0 lie on the layer of the insertion."""
    for part in parts:
        if part.dxf.get("layer", "0") == "0":
            part.dxf.layer = layer
        yield part
