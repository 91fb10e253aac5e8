"""Films and pictures of runs for ``crowdbot export``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

from crowdbot.errors import InputError, UsageError

if TYPE_CHECKING:
    from PIL.Image import Image

    from crowdbot.core.view.film import FilmedRun

#: Formats of films, and of one picture.
FILMS, PICTURE = ("gif", "mp4", "webm"), "png"
_RATE, _WIDTH = {"gif": 12.0, "mp4": 25.0, "webm": 25.0}, {"gif": 640}


@dataclass(frozen=True, slots=True, kw_only=True)
class FilmOptions:
    """Options of ``crowdbot export`` for films; None where the default of the format applies.

    Attributes:
        first, last: first and last time that is shown, s.
        at: times of pictures, s.
        rate: pictures a second.
        speed: how many times faster than real time.
        width: width of the picture, px.
        follow: True to follow the robot, False to show all.
        dark: True for dark colours.
    """

    first: float | None = None
    last: float | None = None
    at: Sequence[float] = ()
    rate: float | None = None
    speed: float | None = None
    width: int | None = None
    follow: bool | None = None
    dark: bool = False

    def check(self, to: str) -> None:
        """Raise an error for options that the chosen format does not use.

        Raises:
            UsageError: an option does not apply to the format.
        """
        names = {"first": "from", "last": "until", "rate": "fps", "follow": "follow"}
        unused = {FILMS[0]: ("at",), PICTURE: ("first", "last", "rate", "speed")}
        kind = PICTURE if to == PICTURE else FILMS[0]
        every = tuple(f.name for f in fields(self))
        for name in unused[kind] if to in (*FILMS, PICTURE) else every:
            value = getattr(self, name)
            if value is not None and value is not False and value != () and value != []:
                raise UsageError(f"--{names.get(name, name)} has no meaning for --to {to}")


def write_film(to: str, recording: Path, out: Path, options: FilmOptions) -> None:
    """Write a film, or pictures at chosen times.

    Raises:
        InputError: the recording has no such times.
        MissingLibraryError: there is no encoder.
    """
    from crowdbot.core.view import encode_film

    filmed = _filmed(recording, options, to)
    if to == PICTURE:
        times = list(options.at) or [_decisive(recording, filmed)]
        for t in times:
            if not 0.0 <= t <= filmed.end:
                raise InputError(f"--at {t:g}: the run lasts {filmed.end:g} s")
        encode_film.write_png(out, list(filmed.images(times)))
        return
    rate, speed = options.rate or _RATE[to], options.speed or 1.0
    times = filmed.times(options.first or 0.0, options.last, rate, speed)
    write = encode_film.write_gif if to == "gif" else encode_film.write_video
    write(out, _watched(filmed, times), rate)


def _filmed(recording: Path, options: FilmOptions, to: str) -> FilmedRun:
    from crowdbot.core.recording.placed_drawings import placed_drawings
    from crowdbot.core.recording.recording import Recording
    from crowdbot.core.view.film import FilmedRun
    from crowdbot.core.view.shapes import DARK, LIGHT

    with Recording(recording) as opened:
        names = tuple(opened.robots)
        tracks = tuple(opened.trajectories(name) for name in names or (None,))
        drawings = [
            placed_drawings(run, opened.drawings(name))
            for run, name in zip(tracks, names or (None,), strict=True)
        ]
        title = opened.header.scenario
    return FilmedRun(
        tracks=tracks,
        title=title,
        width=options.width or _WIDTH.get(to, 960),
        follow=options.follow,
        colours=DARK if options.dark else LIGHT,
        drawings=drawings,
    )


def _decisive(recording: Path, filmed: FilmedRun) -> float:
    """Return the decisive moment of a run, s; for a recording without a run, its middle."""
    from crowdbot.core.why.explain import explain

    try:
        return explain(recording.parent, sensors=False).moment.t
    except InputError:
        return filmed.end / 2


def _watched(filmed: FilmedRun, times: Sequence[float]) -> Iterator[Image]:
    from rich.console import Console
    from rich.progress import track

    images = filmed.images(times)
    console = Console(stderr=True)
    if not console.is_terminal:
        return images
    return iter(track(images, "drawing", total=len(times), console=console, transient=True))
