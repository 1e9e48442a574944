"""Lights with the units of KHR_lights_punctual, and environments."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi
from typing import Literal

from ._brief import Brief, Vector
from .images import RadianceMap


@dataclass(eq=False, repr=False)
class DirectionalLight(Brief):
    """Parallel light from infinitely far away."""

    direction: Vector = (0.0, 0.0, -1.0)  #: direction in which the light travels; any length
    color: Vector = (1.0, 1.0, 1.0)  #: linear Rec. 709
    intensity: float = 1.0  #: illuminance in lux of a surface that faces the light
    name: str = ""


@dataclass(eq=False, repr=False)
class PointLight(Brief):
    """Light from a point in all directions."""

    position: Vector = (0.0, 0.0, 0.0)  #: relative to Scene.origin
    color: Vector = (1.0, 1.0, 1.0)  #: linear Rec. 709
    intensity: float = 1.0  #: candela
    range: float = inf  #: distance at which the light has faded to 0
    name: str = ""


@dataclass(eq=False, repr=False)
class SpotLight(Brief):
    """Light from a point in a cone: full intensity within the inner angle, and none beyond the
    outer. Both angles are in radians and measured from the axis; the intensity is in candela."""

    position: Vector = (0.0, 0.0, 0.0)  #: relative to Scene.origin
    direction: Vector = (0.0, 0.0, -1.0)  #: direction of the cone's axis; any length
    color: Vector = (1.0, 1.0, 1.0)  #: linear Rec. 709
    intensity: float = 1.0  #: candela along the axis
    range: float = inf  #: distance at which the light has faded to 0
    inner_cone_angle: float = 0.0  #: radians from the axis
    outer_cone_angle: float = pi / 4  #: radians from the axis, at most pi / 2
    name: str = ""


Light = DirectionalLight | PointLight | SpotLight


@dataclass(eq=False, repr=False)
class Environment(Brief):
    """Light from all directions in path-traced pictures. The rotation is in radians."""

    #: The built-in studio, uniform radiance (linear Rec. 709), or a latitude-longitude map.
    content: Literal["studio"] | Vector | RadianceMap = (1.0, 1.0, 1.0)
    rotation: float = 0.0  #: radians about +y, counterclockwise as seen from above
    intensity: float = 1.0  #: multiplies the content
    #: True if the environment is visible where camera rays hit nothing, in place of
    #: Scene.background.
    is_background: bool = False
