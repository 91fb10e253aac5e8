"""The task of a robot whose goal is a person, as a message of its own.

It is apart from the header, so that recordings of other tasks keep their bytes.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import crowdbot.core.recording.messages as ros
from crowdbot.core.types.person_task import PersonTask, TaskPerson
from crowdbot.errors import InputError

_TEXTS, _NUMBERS = ("knows", "side"), ("distance", "tolerance", "angle", "hold", "radius")


def person_task_message(person: TaskPerson) -> Any:
    """Return a task and its people as ``crowdbot_msgs/PersonTask``."""
    task = person.task
    return ros.new(
        "crowdbot_msgs/PersonTask",
        task=task.kind,
        person=np.ascontiguousarray(person.id, np.int64),
        facing=np.ascontiguousarray(person.facing, np.float64),
        in_a_row=task.in_a_row,
        **{name: getattr(task, name) for name in (*_TEXTS, *_NUMBERS)},
    )


def person_task_of(message: Any) -> TaskPerson:
    """Read a message of `person_task_message`.

    Raises:
        InputError: it contradicts itself.
    """
    if len(message.person) != len(message.facing) or not len(message.person):
        raise InputError("the recording names people of its task and facings of unequal number")
    values: dict[str, Any] = {name: getattr(message, name) for name in (*_TEXTS, *_NUMBERS)}
    return TaskPerson(
        task=PersonTask(kind=message.task, **values, in_a_row=bool(message.in_a_row)),
        id=message.person,
        facing=message.facing,
    )
