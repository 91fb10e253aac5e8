"""Names used as folders: ids of suites and scenarios, and labels of planners."""

from __future__ import annotations

import re
from typing import Annotated

from pydantic import AfterValidator
from pydantic_core import PydanticCustomError

#: Longest name, and longest path of several; file systems allow 255 bytes, and we append to it.
LONGEST = 200
_OURS = re.compile(r"\.partial|\.old-|\.failure\.json$")
_SEED = re.compile(r"seed-\d+")


def path_problem(name: str) -> str:
    """Return why a name cannot be a folder below the results' root; empty if it can.

    Args:
        name: a name, or several with ``/`` between them.
    """
    if len(name.encode()) > LONGEST:
        return f"has {len(name.encode())} bytes; at most {LONGEST} make a folder"
    for part in name.split("/"):
        if not part:
            return "begins or ends with '/', or has an empty part"
        if part[0] == "." or "\\" in part or "\0" in part:
            return f"leads out of the folder of results, or is hidden: '{part[:60]}'"
        if part == "references" or _OURS.search(part) or _SEED.fullmatch(part):
            return f"has a part that crowdbot needs for folders of its own: '{part[:60]}'"
    return ""


def _checked(name: str) -> str:
    if why := path_problem(name):
        raise PydanticCustomError("path_name", "{why}", {"why": why})
    return name


#: Text that can be a folder's path.
PathName = Annotated[str, AfterValidator(_checked)]
