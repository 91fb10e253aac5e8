"""A window that shows a world from above while it is stepped, ``render_mode="human"``."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.errors import InputError, MissingLibraryError
from crowdbot.rl.libraries import found

#: Ways of rendering: none, an array of pixels, a window.
RENDER_MODES = ("rgb_array", "human")


def check_render_mode(mode: str | None) -> None:
    """Check a mode of rendering.

    Raises:
        InputError: there is no such mode.
        MissingLibraryError: it needs pygame, which is not installed.
    """
    if mode not in (None, *RENDER_MODES):
        known = " or ".join(map(repr, RENDER_MODES))
        raise InputError(f"render_mode must be {known} or None, not {mode!r}")
    if mode == "human" and found("pygame") is None:
        raise MissingLibraryError(
            "render_mode 'human' needs pygame; install it with: pip install pygame"
        )


class Window:
    """A window of pygame, opened with the first picture."""

    def __init__(self, title: str) -> None:
        self._title = title
        self._surface: Any = None

    def show(self, pixels: NDArray[np.uint8]) -> None:
        """Show a picture (H, W, 3)."""
        import pygame

        if self._surface is None:
            pygame.display.init()
            self._surface = pygame.display.set_mode((pixels.shape[1], pixels.shape[0]))
            pygame.display.set_caption(self._title)
        pygame.event.pump()
        pygame.surfarray.blit_array(self._surface, pixels.swapaxes(0, 1))
        pygame.display.flip()

    def close(self) -> None:
        """Close the window, if it is open."""
        if self._surface is not None:
            import pygame

            pygame.display.quit()
            self._surface = None
