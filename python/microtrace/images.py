"""Images of textures and environments. Both are immutable and shared, never copied, by scenes."""

from __future__ import annotations

from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from .errors import warn


class Image:
    """Pixels of a texture, as in its file: whether they are sRGB or linear is up to the material.

    Args:
        pixels: (height, width) or (height, width, channels) of uint8 or uint16, copied; the maximum
            means 1. 1 channel: gray, 2: gray and alpha, 3: rgb, 4: rgb and alpha. Colors are not
            premultiplied.
        name: any text.
    """

    def __init__(self, pixels: npt.ArrayLike, name: str = "") -> None:
        array: npt.NDArray[Any] = np.asarray(pixels)
        if array.dtype not in (np.uint8, np.uint16):
            raise TypeError(f"pixels must be uint8 or uint16, not {array.dtype}")
        if array.ndim == 2:
            array = array[:, :, None]
        if array.ndim != 3 or not 1 <= array.shape[2] <= 4 or array.size == 0:
            raise ValueError(
                f"pixels must have shape (height, width, 1 to 4) and not be empty: {array.shape}"
            )
        self._data = _core.ImageData(
            np.ascontiguousarray(array, array.dtype.newbyteorder("=")), name
        )

    @property
    def pixels(self) -> npt.NDArray[Any]:
        """(height, width, channels), read-only and not copied."""
        return self._data.pixels

    @property
    def name(self) -> str:
        """The name in its file."""
        return self._data.name

    def __reduce__(self) -> Any:
        return (Image, (self.pixels, self.name))

    def __deepcopy__(self, memo: Any) -> Image:
        return self

    def __repr__(self) -> str:
        return f"Image({self.name!r}, {self.pixels.shape}, {self.pixels.dtype})"


class RadianceMap:
    """A latitude-longitude map of light: the unit direction (x, y, z) is at
    u = atan2(z, x) / 2 pi + 1/2, v = acos(y) / pi, where (0, 0) is the upper left corner.

    Args:
        pixels: (height, width, 3) real numbers, linear Rec. 709, in [0, 1e9]; copied.
    """

    def __init__(self, pixels: npt.ArrayLike) -> None:
        array: npt.NDArray[Any] = np.asarray(pixels)
        if array.dtype.kind not in "fiu":
            raise TypeError(f"pixels must contain real numbers, not {array.dtype}")
        if array.ndim != 3 or array.shape[2] != 3 or array.size == 0:
            raise ValueError(f"pixels must have shape (height, width, 3), not {array.shape}")
        self._data = _core.MapData(np.ascontiguousarray(array, np.float32))

    @property
    def pixels(self) -> npt.NDArray[Any]:
        """(height, width, 3) float32, read-only and not copied."""
        return self._data.pixels

    def __reduce__(self) -> Any:
        return (RadianceMap, (self.pixels,))

    def __deepcopy__(self, memo: Any) -> RadianceMap:
        return self

    def __repr__(self) -> str:
        return f"RadianceMap({self.pixels.shape})"


def load_map(path: str | PathLike[str]) -> RadianceMap:
    """Reads a latitude-longitude map (.exr; .hdr and others where OpenImageIO is installed).

    Warns:
        SceneWarning: values out of range, which are clamped.

    Raises:
        FileError, LimitError, UnsupportedError.
    """
    data, diagnostics = _core.load_map(path)
    warn(diagnostics)
    return _map_of(data)


def _image_of(data: _core.ImageData) -> Image:
    result = Image.__new__(Image)
    result._data = data
    return result


def _map_of(data: _core.MapData) -> RadianceMap:
    result = RadianceMap.__new__(RadianceMap)
    result._data = data
    return result
