"""Images of textures and environments. They are immutable; scenes share them instead of copying
them."""

from __future__ import annotations

from os import PathLike
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import as_array, as_float32, as_path, as_reals, as_text
from .errors import warn


class PillowImage(Protocol):
    """What Image uses of Pillow's class."""

    @property
    def mode(self) -> str: ...
    def convert(self, mode: str) -> Any: ...


class Image:
    """Pixels of a texture, as stored in its file. The material determines whether they are sRGB or
    linear.

    Args:
        pixels: (height, width) or (height, width, channels) of uint8 or uint16, which are copied.
            The maximum value means 1. The channels are gray; gray and alpha; rgb; or rgb and alpha.
            Colors are not premultiplied. Pillow's images may have any mode except F, I and LAB, and
            a transparent color.
        name: any text.
    """

    def __init__(self, pixels: npt.ArrayLike | PillowImage, name: str = "") -> None:
        array = as_array(_direct(pixels), "pixels")
        if array.ndim == 0:
            raise TypeError(f"pixels must be an array of uint8 or uint16, not {pixels!r}")
        if array.dtype.newbyteorder("=") not in (np.uint8, np.uint16):
            raise TypeError(f"pixels must be uint8 or uint16, not {array.dtype}")
        if array.ndim == 2:
            array = array[:, :, None]
        if array.ndim != 3 or not 1 <= array.shape[2] <= 4 or array.size == 0:
            raise ValueError(
                f"pixels must have shape (height, width, 1 to 4) and not be empty: {array.shape}"
            )
        self._data = _core.ImageData(
            np.ascontiguousarray(array, array.dtype.newbyteorder("=")), as_text(name, "name")
        )

    @property
    def pixels(self) -> npt.NDArray[Any]:
        """A read-only view of shape (height, width, channels)."""
        return self._data.pixels

    @property
    def name(self) -> str:
        """The image's name."""
        return self._data.name

    def __reduce__(self) -> Any:
        return (Image, (self.pixels, self.name))

    def __deepcopy__(self, memo: Any) -> Image:
        return self

    def __repr__(self) -> str:
        return f"Image({self.name!r}, {self.pixels.shape}, {self.pixels.dtype})"


class RadianceMap:
    """A latitude-longitude map of radiance. The unit direction (x, y, z) is at
    u = atan2(z, x) / 2 pi + 1/2 and v = acos(y) / pi, where (0, 0) is the upper left corner.

    Args:
        pixels: (height, width, 3) real numbers in [0, 1e9], linear Rec. 709, which are copied.
    """

    def __init__(self, pixels: npt.ArrayLike) -> None:
        array = as_reals(pixels, "pixels")
        if array.ndim != 3 or array.shape[2] != 3 or array.size == 0:
            raise ValueError(f"pixels must have shape (height, width, 3), not {array.shape}")
        self._data = _core.MapData(as_float32(array))

    @property
    def pixels(self) -> npt.NDArray[Any]:
        """A read-only view of shape (height, width, 3), float32."""
        return self._data.pixels

    def __reduce__(self) -> Any:
        return (RadianceMap, (self.pixels,))

    def __deepcopy__(self, memo: Any) -> RadianceMap:
        return self

    def __repr__(self) -> str:
        return f"RadianceMap({self.pixels.shape})"


#: Modes of Pillow's images whose pixels are the numbers of an Image.
_DIRECT_MODES = ("L", "LA", "RGB", "RGBA", "I;16", "I;16L", "I;16B", "I;16N")
#: The modes that Pillow converts to others.
_CONVERSIONS = {
    **dict.fromkeys(("1", "P", "PA", "RGBa", "RGBX", "CMYK", "YCbCr", "HSV"), "RGBA"),
    "La": "LA",
}


def _direct(pixels: Any) -> Any:
    """Converts Pillow's images with palettes, a transparent color, premultiplied colors, or other
    color spaces than RGB."""
    if not (hasattr(pixels, "mode") and hasattr(pixels, "convert")):
        return pixels
    mode = pixels.mode
    has_hole = "transparency" in getattr(pixels, "info", {})
    if has_hole and mode.startswith("I;16"):
        gray = np.asarray(pixels)
        alpha = np.where(gray == pixels.info["transparency"], 0, 65535)
        return np.stack([gray, alpha], axis=2).astype(np.uint16)
    if mode in _DIRECT_MODES:
        return pixels.convert(f"{mode}A") if has_hole and mode in ("L", "RGB") else pixels
    if mode not in _CONVERSIONS:
        raise ValueError(
            f"pixels of Pillow's mode {mode} have no definite colors; convert the image to RGB or L"
        )
    return pixels.convert(_CONVERSIONS[mode])


def load_map(path: str | bytes | PathLike[str]) -> RadianceMap:
    """Reads a latitude-longitude map from .exr or, if the package was built with OpenImageIO, .hdr
    and other formats. `pip install` builds it without.

    Warns:
        SceneWarning: values are out of range and were clamped.

    Raises:
        FileError, LimitError, UnsupportedError.
    """
    data, diagnostics = _core.load_map(as_path(path, "path"))
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
