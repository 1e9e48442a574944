"""Motion blur."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ._brief import Brief
from .cameras import Camera
from .prepared import PreparedScene
from .scene import Scene


@dataclass(eq=False, repr=False)
class Shutter(Brief):
    """The time during which a path-traced picture collects light from a moving scene.

    Each sample sees the scene at one of `times` times: the middles of equal slices of the time from
    `open` to `close`. All samples of a slice are rendered before the next one.
    """

    #: Returns the scene and the camera at a time in seconds, always the same for the same time. It
    #: is called for all times in ascending order. The camera is relative to the scene's origin.
    moment: Callable[[float], tuple[Scene | PreparedScene, Camera]]
    open: float  #: seconds
    close: float  #: seconds, not before `open`
    times: int = 64  #: a power of two
