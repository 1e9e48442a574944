"""Cameras. Positions are relative to Scene.origin, which is 0 except for files whose content is far
from the origin of world space."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf, radians
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from ._arrays import as_real, as_reals, as_size, as_vector
from ._brief import Brief, Vector


@dataclass(eq=False, repr=False, kw_only=True)
class _Posed(Brief):
    position: Vector = (0.0, 0.0, 0.0)  #: relative to Scene.origin
    direction: Vector = (0.0, 0.0, -1.0)  #: viewing direction; any length
    up: Vector = (0.0, 1.0, 0.0)  #: need not be perpendicular to direction
    name: str = ""


@dataclass(eq=False, repr=False, kw_only=True)
class PerspectiveCamera(_Posed):
    """Perspective projection with square pixels. The vertical field of view is in radians;
    look_at() takes degrees."""

    vertical_fov: float = 1.0  #: radians, in (0, pi)
    #: If given, the vertical field of view spans the height of a window with this width / height,
    #: which is fitted into the picture, as in glTF. Otherwise it spans the picture's height.
    aspect_ratio: float | None = None
    #: Depth of the points that are sharp if the camera has a lens; positive.
    focus: float = 1.0
    #: Radius of the lens in world units; 0 is a pinhole. Only path-traced pictures show blur.
    lens_radius: float = 0.0
    near: float = 0.0  #: depth from which surfaces are visible
    far: float = inf  #: depth up to which surfaces are visible


@dataclass(eq=False, repr=False, kw_only=True)
class OrthographicCamera(_Posed):
    """Orthographic projection with square pixels."""

    height: float = 2.0  #: height of the picture in world units
    aspect_ratio: float | None = None  #: as in PerspectiveCamera
    near: float = 0.0  #: depth from which surfaces are visible
    far: float = inf  #: depth up to which surfaces are visible


@dataclass(eq=False, repr=False, kw_only=True)
class EnvironmentCamera(_Posed):
    """A latitude-longitude projection of all directions, with the viewing direction in the
    center."""


@dataclass(eq=False, repr=False)
class RationalDistortion(Brief):
    """OpenCV's rational model of radial and tangential lens distortion."""

    k1: float = 0.0
    k2: float = 0.0
    p1: float = 0.0
    p2: float = 0.0
    k3: float = 0.0
    k4: float = 0.0
    k5: float = 0.0
    k6: float = 0.0


@dataclass(eq=False, repr=False)
class FisheyeDistortion(Brief):
    """OpenCV's model of fisheye lens distortion."""

    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    k4: float = 0.0


@dataclass(eq=False, repr=False, kw_only=True)
class CalibratedCamera(_Posed):
    """A camera with the parameters of OpenCV's calibration. cameras() makes it from matrices.

    A picture whose size differs from `image_size` shows the same view. Pixels where the distortion
    is not invertible have no rays: nothing is visible there, and the color is black.
    """

    image_size: tuple[int, int] = (640, 480)  #: width and height of the calibration images
    fx: float = 640.0  #: focal lengths in pixels
    fy: float = 640.0
    cx: float = 319.5  #: principal point in pixels; pixel centers have integer coordinates
    cy: float = 239.5
    distortion: RationalDistortion | FisheyeDistortion = field(default_factory=RationalDistortion)
    near: float = 0.0  #: depth from which surfaces are visible; distance for fisheye lenses
    far: float = inf  #: depth up to which surfaces are visible; distance for fisheye lenses


Camera = PerspectiveCamera | OrthographicCamera | EnvironmentCamera | CalibratedCamera


def look_at(
    eye: Vector, target: Vector, up: Vector = (0.0, 1.0, 0.0), vertical_fov_degrees: float = 45.0
) -> PerspectiveCamera:
    """Returns a perspective camera at `eye` that looks at `target`. The field of view is in
    degrees."""
    position = as_vector(eye, "eye")
    x, y, z = (t - e for t, e in zip(as_vector(target, "target"), position))
    return PerspectiveCamera(
        position=position,
        direction=(x, y, z),
        up=as_vector(up, "up"),
        vertical_fov=radians(as_degrees(vertical_fov_degrees)),
    )


def as_degrees(vertical_fov: Any) -> float:
    """Returns a vertical field of view in degrees."""
    degrees = as_real(vertical_fov, "vertical_fov_degrees", 0, 180)
    if not 0 < degrees < 180:
        raise ValueError(f"vertical_fov_degrees must be in (0, 180), is {degrees}")
    return degrees


def cameras(
    K: npt.ArrayLike,
    T: npt.ArrayLike,
    size: tuple[int, int],
    *,
    convention: Literal["opencv", "opengl"],
    distortion: npt.ArrayLike = (),
    fisheye: npt.ArrayLike | None = None,
) -> list[CalibratedCamera]:
    """Makes cameras from matrices of intrinsic and extrinsic parameters.

    Args:
        K: (3, 3) or (N, 3, 3) matrices with fx and fy on the diagonal and cx and cy in the last
            column, in pixels, without skew.
        T: (4, 4) or (N, 4, 4) rigid transformations. World space is that of positions relative to
            Scene.origin.
        size: width and height of the images to which K belongs.
        convention: with "opencv", T maps world space to camera space, the camera looks along +z, +y
            points down, and pixel centers have integer coordinates. With "opengl", T maps camera
            space to world space, the camera looks along -z, +y points up, and pixel centers are at
            integers + 0.5. Both conventions count pixels from the upper left.
        distortion: k1, k2, p1, p2 and, optionally, k3 to k6, as cv2.calibrateCamera returns them.
        fisheye: k1 to k4 of cv2.fisheye, in place of `distortion`.

    Raises:
        ValueError: a matrix has a wrong shape, K has skew, T is not rigid, or a distortion
            coefficient is not supported.
    """
    if not isinstance(convention, str) or convention not in ("opencv", "opengl"):
        raise ValueError(f'convention must be "opencv" or "opengl", not {convention!r}')
    intrinsic = _matrices(K, 3, "K")
    extrinsic = _matrices(T, 4, "T")
    count = max(len(intrinsic), len(extrinsic))
    if len(intrinsic) not in (1, count) or len(extrinsic) not in (1, count):
        raise ValueError(f"K and T must have the same length: {len(intrinsic)}, {len(extrinsic)}")
    size = as_size(size)
    model = _distortion(_coefficients(distortion, "distortion"), fisheye)
    return [
        _calibrated(
            intrinsic[k % len(intrinsic)], extrinsic[k % len(extrinsic)], size, convention, model
        )
        for k in range(count)
    ]


def _matrices(values: npt.ArrayLike, width: int, name: str) -> npt.NDArray[np.float64]:
    array = as_reals(values, name).astype(np.float64)
    if array.ndim not in (2, 3) or array.shape[-2:] != (width, width):
        raise ValueError(
            f"{name} must have shape ({width}, {width}) or (N, {width}, {width}), not {array.shape}"
        )
    return array.reshape(-1, width, width)


def _distortion(
    rational: npt.NDArray[np.float64], fisheye: npt.ArrayLike | None
) -> RationalDistortion | FisheyeDistortion:
    if fisheye is not None:
        numbers = _coefficients(fisheye, "fisheye")
        if rational.any():
            raise ValueError("give either distortion or fisheye")
        if len(numbers) != 4:
            raise ValueError(f"fisheye must have 4 coefficients, not {len(numbers)}")
        return FisheyeDistortion(*map(float, numbers))
    if len(rational) not in (0, 4, 5, 8, 12, 14):
        raise ValueError(f"distortion must have 4, 5 or 8 coefficients, not {len(rational)}")
    if rational[8:].any():
        raise ValueError("thin prisms and tilted sensors (coefficients 9 to 14) are not supported")
    return RationalDistortion(*map(float, rational[:8]))


def _coefficients(values: npt.ArrayLike, name: str) -> npt.NDArray[np.float64]:
    array = as_reals(values, name)
    # OpenCV returns coefficients as a row or a column.
    if max(array.shape, default=1) != array.size:
        raise ValueError(f"{name} must be the coefficients of one camera, not {array.shape}")
    return array.astype(np.float64).ravel()


def _calibrated(
    k: npt.NDArray[np.float64],
    t: npt.NDArray[np.float64],
    size: tuple[int, int],
    convention: str,
    distortion: RationalDistortion | FisheyeDistortion,
) -> CalibratedCamera:
    if k[0, 1] != 0 or k[1, 0] != 0 or not np.array_equal(k[2], (0, 0, 1)):
        raise ValueError("K must have the rows (fx, 0, cx), (0, fy, cy), (0, 0, 1)")
    rotation, shift = t[:3, :3], t[:3, 3]
    gram = (rotation[:, :, None] * rotation[:, None, :]).sum(0)
    is_rotation = np.allclose(gram, np.eye(3), atol=1e-4) and _volume(rotation) > 0
    if not is_rotation or not np.array_equal(t[3], (0, 0, 0, 1)):
        raise ValueError("T must be a rotation and a translation, with the last row 0, 0, 0, 1")
    if convention == "opencv":
        position = -(rotation * shift[:, None]).sum(0)
        direction, up, center = rotation[2], -rotation[1], 0.0
    else:
        position, direction, up, center = shift, -rotation[:, 2], rotation[:, 1], 0.5
    return CalibratedCamera(
        position=_vector(position),
        direction=_vector(direction),
        up=_vector(up),
        image_size=size,
        fx=float(k[0, 0]),
        fy=float(k[1, 1]),
        cx=float(k[0, 2]) - center,
        cy=float(k[1, 2]) - center,
        distortion=distortion,
    )


def _volume(m: npt.NDArray[np.float64]) -> float:
    a, b, c = m
    cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return float(cross[0] * c[0] + cross[1] * c[1] + cross[2] * c[2])


def _vector(values: npt.NDArray[Any]) -> Vector:
    x, y, z = map(float, values)
    return (x, y, z)
