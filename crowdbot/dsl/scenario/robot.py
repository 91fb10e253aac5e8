"""Robot: its model, task and sensors."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    Field,
    SerializeAsAny,
    ValidationInfo,
    field_validator,
    model_validator,
)

from crowdbot.dsl.scenario.person_goals import (
    AccompanyGoal,
    ApproachGoal,
    FollowGoal,
    LeadGoal,
    PersonGoal,
    TaskGoal,
)
from crowdbot.dsl.spec.component_specs import RobotSpec, SensorSpec
from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.quantities import Angle, Length, PositiveDuration
from crowdbot.dsl.spec.spec import Spec


class Goal(TaskGoal):
    """The zone that the robot's centre has to reach."""

    kind: Literal["zone"] = default(
        "zone", "A place; other kinds of goals are people.", omitted=True
    )
    zone: str = Field(description="Name of the goal zone.")


def _zone_unless_given(value: Any) -> Any:
    """Add the default ``kind`` to a goal that names none."""
    return {"kind": TaskGoal.usual, **value} if isinstance(value, dict) else value


#: A zone, or a person with what to do.
GoalChoice = Annotated[
    Annotated[
        Goal | ApproachGoal | FollowGoal | AccompanyGoal | LeadGoal, Field(discriminator="kind")
    ],
    BeforeValidator(_zone_unless_given),
]


class TaskSpec(Spec):
    """The robot's task."""

    start: tuple[Length, Length, Angle] = Field(
        strict=False, description="x, y (m) and heading (rad) at t = 0, world frame."
    )
    goal: GoalChoice = Field(description="A zone to reach, or a person to be with.")
    time_limit: PositiveDuration = default(180.0, "The run ends here, s.")
    when_ended: Literal["stay", "leave"] = default(
        "stay",
        "Of one robot among several that has arrived, failed or run out of time: it "
        "stays where it is, as an obstacle, or leaves.",
        omitted=True,
    )

    @property
    def zone(self) -> str | None:
        """Return the name of the zone in which the task ends; None if a person alone decides."""
        return self.goal.zone if isinstance(self.goal, Goal | LeadGoal) else None

    @property
    def person(self) -> PersonGoal | None:
        """Return the goal if it is a person."""
        return self.goal if isinstance(self.goal, PersonGoal) else None


class Robot(Spec):
    """One robot with its sensors and its task."""

    model: SerializeAsAny[RobotSpec]
    control: Literal["kinematic", "force", "differential_drive"] = Field(
        default="differential_drive",
        validate_default=False,  # a mismatch is replaced
        description="How commands become motion. Default of a holonomic robot: force.",
    )
    sensors: dict[str, SerializeAsAny[SensorSpec]] = default({}, "Named sensors.")
    task: TaskSpec

    @field_validator("control")
    @classmethod
    def _fits_the_drive(cls, value: str, info: ValidationInfo) -> str:
        model = info.data.get("model")
        if model is not None and value not in model.controls:
            raise ValueError(f"does not fit {model.kind}; what does: {', '.join(model.controls)}")
        return value

    @model_validator(mode="after")
    def _default_that_fits(self) -> Robot:
        if "control" not in self.model_fields_set:
            object.__setattr__(self, "control", self.model.controls[0])
        return self

    @model_validator(mode="after")
    def _sensors_on_the_robot(self) -> Robot:
        """Fill what the sensors take from the robot's spec, such as the wheels of odometry."""
        fitted = {n: s.on_robot(self.model) for n, s in self.sensors.items()}
        object.__setattr__(self, "sensors", fitted)
        return self
