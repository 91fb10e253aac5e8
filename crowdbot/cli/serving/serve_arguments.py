"""Arguments of ``crowdbot serve``."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from crowdbot.cli.shared.option import option, switch


class ClockChoice(StrEnum):
    """Source of simulated time."""

    internal = "internal"
    external = "external"


class DistroChoice(StrEnum):
    """Distribution of ROS 2."""

    humble = "humble"
    jazzy = "jazzy"
    kilted = "kilted"
    lyrical = "lyrical"


class MissedChoice(StrEnum):
    """Behaviour of a step without a command."""

    stop = "stop"
    hold = "hold"
    fail = "fail"


Host = Annotated[
    str, typer.Option(help="Address to listen on; from other machines clients need a token.")
]
Port = Annotated[
    int, typer.Option(min=0, max=65535, help="Port of the rosbridge server; 0: a free one.")
]
Token = Annotated[
    str | None,
    typer.Option(help="Token that clients must give; default on the network: a new one."),
]
Connect = Annotated[str | None, option("ws://HOST:PORT", "Be a client of this rosbridge server.")]
Stamped = Annotated[bool, switch("--stamped", "With --connect: commands are TwistStamped.")]
Zenoh = Annotated[
    str | None, option("tcp/HOST:PORT", "ROS 2 topics, too, through this zenoh router.")
]
ZenohRouter = Annotated[bool, switch("--zenoh-router", "Be the zenoh router at that endpoint.")]
Domain = Annotated[int, typer.Option(min=0, max=232, help="ROS_DOMAIN_ID.")]
Distro = Annotated[DistroChoice, typer.Option(help="ROS 2 distribution of the nodes.")]
Foxglove = Annotated[
    int | None,
    typer.Option(min=0, max=65535, metavar="PORT", help="A live view for Foxglove as well."),
]
AllowOrigin = Annotated[
    list[str] | None, option("ORIGIN", "Admit pages of this website, SCHEME://HOST; repeatable.")
]
Rate = Annotated[float | None, option("FACTOR", "Keep to real time, times FACTOR; else lockstep.")]
Clock = Annotated[ClockChoice, typer.Option(help="Where simulated time comes from.")]
Budget = Annotated[float, option("SECONDS", "Lockstep: how long a step waits for a command.")]
Missed = Annotated[MissedChoice, typer.Option(help="What a step without a command does.")]
Hold = Annotated[float, option("SECONDS", "Real time: how long a command counts.")]
Wait = Annotated[float | None, option("SECONDS", "Time to wait for a client; default: no limit.")]
Epoch = Annotated[int, typer.Option(min=0, metavar="SECONDS", help="Time at which stamps begin.")]
RosVersion = Annotated[int, typer.Option(min=1, max=2, help="ROS 1 or ROS 2 messages.")]
PlannerName = Annotated[str, typer.Option(help="Name of the planner that drives.")]
Stay = Annotated[bool, switch("--stay", "After a run, wait for reset or next_scenario.")]
References = Annotated[bool, typer.Option(help="First run the robot alone and the people alone.")]
