"""Cameras in world space."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, radians

Vector = tuple[float, float, float]


@dataclass(eq=False, kw_only=True)
class _Posed:
    position: Vector = (0.0, 0.0, 0.0)  #: world space
    direction: Vector = (0.0, 0.0, -1.0)  #: of view; any length
    up: Vector = (0.0, 1.0, 0.0)  #: need not be perpendicular to direction
    name: str = ""


@dataclass(eq=False, kw_only=True)
class PerspectiveCamera(_Posed):
    """Perspective projection with square pixels."""

    vertical_fov: float = 1.0  #: radians, in (0, pi)
    #: If given, a window with this width / height is fitted into the picture, as in glTF; else the
    #: vertical field of view spans the picture's height.
    aspect_ratio: float | None = None
    near: float = 0.0  #: depth from which surfaces are visible
    far: float = inf  #: depth up to which surfaces are visible


@dataclass(eq=False, kw_only=True)
class OrthographicCamera(_Posed):
    """Orthographic projection with square pixels."""

    height: float = 2.0  #: of the picture, world units
    aspect_ratio: float | None = None  #: as in PerspectiveCamera
    near: float = 0.0  #: depth from which surfaces are visible
    far: float = inf  #: depth up to which surfaces are visible


@dataclass(eq=False, kw_only=True)
class EnvironmentCamera(_Posed):
    """A latitude-longitude map of all directions, with the viewing direction in the middle."""


Camera = PerspectiveCamera | OrthographicCamera | EnvironmentCamera


def look_at(
    eye: Vector, target: Vector, up: Vector = (0.0, 1.0, 0.0), vertical_fov_degrees: float = 45.0
) -> PerspectiveCamera:
    """A perspective camera at `eye` that looks at `target`. The field of view is in degrees."""
    x, y, z = (float(t) - float(e) for t, e in zip(target, eye, strict=True))
    return PerspectiveCamera(
        position=eye, direction=(x, y, z), up=up, vertical_fov=radians(vertical_fov_degrees)
    )
