"""Checks and conversions of array arguments."""

from __future__ import annotations

import math
import operator
import os
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]

#: The greatest integer that C++ code takes.
MOST = 2**63 - 1


def _has_masked(values: Any) -> bool:
    if isinstance(values, np.ma.MaskedArray):
        return bool(np.ma.is_masked(values))
    return isinstance(values, (list, tuple)) and any(
        isinstance(row, (list, tuple, np.ma.MaskedArray)) and _has_masked(row) for row in values
    )


def as_array(values: Any, what: str) -> Array:
    """Converts lists, and objects that NumPy converts. Raises ValueError for lists of unequal
    lengths, and for masked arrays in which something is masked."""
    if _has_masked(values):
        raise ValueError(f"{what} must not have masked values; replace them, as by filled()")
    try:
        return np.asarray(values)
    except ValueError as error:
        raise ValueError(f"{what} can't be converted to an array: {error}") from None


def as_reals(values: Any, what: str) -> Array:
    """Returns an array of real numbers of any shape and type. Raises TypeError for others."""
    array = as_array(values, what)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{what} must contain real numbers, not {array.dtype}")
    return array


def as_numbers(values: Any, what: str, width: int) -> Array:
    """Returns an array of shape (..., width) of float32 or float64, in native byte order. An empty
    list has no rows.

    Neither copies nor converts float32 and float64 arrays. Raises ValueError for a different width,
    and TypeError for anything but real numbers.
    """
    array = as_array(values, what)
    if array.shape == (0,):  # an empty list
        return np.zeros((0, width), np.float32)
    array = as_reals(array, what)
    if array.ndim == 0 or array.shape[-1] != width:
        raise ValueError(f"{what} must have shape (..., {width}), not {array.shape}")
    if array.dtype.kind == "f" and array.dtype.itemsize in (4, 8):
        return array.astype(array.dtype.newbyteorder("="), copy=False)
    return array.astype(np.float64)


def as_float32(values: npt.ArrayLike) -> npt.NDArray[np.float32]:
    """Returns a C-contiguous array of rounded numbers. Numbers beyond float32 become infinite or 0,
    without a warning."""
    with np.errstate(over="ignore", under="ignore"):
        return np.ascontiguousarray(values, np.float32)


def as_float32_toward(values: Array, limit: float) -> npt.NDArray[np.float32]:
    """Like as_float32(), but rounds numbers toward the limit, which is infinity or -infinity."""
    rounded = as_float32(values)
    is_beyond = rounded < values if limit > 0 else rounded > values
    if not is_beyond.any():
        return rounded
    return np.where(is_beyond, np.nextafter(rounded, np.float32(limit)), rounded)


def as_rows(values: Any, what: str, width: int) -> Array:
    """Like as_numbers(), for shape (n, width) and with strides that C++ code can read."""
    array = as_array(values, what)
    if array.shape != (0,) and (array.ndim != 2 or array.shape[1] != width):
        raise ValueError(f"{what} must have shape (n, {width}), not {array.shape}")
    return readable(as_numbers(array, what, width))


def as_indices(values: Any, what: str, width: int) -> Array:
    """Returns an array of shape (n, width) of 32-bit or 64-bit integers. Raises like
    as_numbers()."""
    array = as_array(values, what)
    if array.size == 0 and array.ndim < 2:
        array = np.zeros((0, width), np.uint32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{what} must contain integers, not {array.dtype}")
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{what} must have shape (n, {width}), not {array.shape}")
    if array.dtype.itemsize < 4:
        array = array.astype(np.uint32 if array.dtype.kind == "u" else np.int32)
    if array.dtype.kind == "i" and array.size and int(array.min()) < 0:
        raise ValueError(f"{what} must not be negative; found {int(array.min())}")
    if array.dtype.itemsize == 8 and array.size and int(array.max()) >= 2**32:
        raise ValueError(f"{what} must be less than 2^32; found {int(array.max())}")
    return readable(array.astype(array.dtype.newbyteorder("="), copy=False))


def as_affine(values: Any, what: str) -> list[float]:
    """Returns the columns of an affine (3, 4) or (4, 4) matrix as 16 numbers. Raises ValueError for
    another shape, another last row than (0, 0, 0, 1), or numbers that are not finite."""
    matrix = as_reals(values, what)
    if matrix.shape not in ((3, 4), (4, 4)):
        raise ValueError(f"{what} must have shape (3, 4) or (4, 4), not {matrix.shape}")
    whole = np.identity(4)
    whole[: len(matrix)] = matrix
    if not np.isfinite(whole).all():
        raise ValueError(f"{what} must be finite")
    if not np.array_equal(whole[3], (0, 0, 0, 1)):
        raise ValueError(f"the last row of {what} must be (0, 0, 0, 1)")
    return [float(number) for number in whole.T.flat]


def readable(array: Array) -> Array:
    """Returns the array, or a copy if its data are not aligned or its strides are not multiples of
    the item size."""
    is_plain = array.flags.aligned and all(s % array.itemsize == 0 for s in array.strides)
    return array if is_plain else np.ascontiguousarray(array)


def as_integer(value: Any, what: str, low: int, high: int) -> int:
    """Returns an integer in [low, high]. Raises TypeError or ValueError otherwise."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{what} must be an integer, not {value!r}") from None
    if not low <= number <= high:
        limits = f"at least {low}" if number < low and high == MOST else f"from {low} to {high}"
        raise ValueError(f"{what} must be {limits}, not {number}")
    return number


def as_real(value: Any, what: str, low: float, high: float, accepted: str = "a number") -> float:
    """Returns a number in [low, high]. Raises TypeError or ValueError otherwise.

    accepted describes the values that the caller accepts, for messages.
    """
    number = as_float(value, what, accepted)
    if not low <= number <= high:
        raise ValueError(f"{what} must be from {low} to {high}, not {number}")
    return number


def as_float(value: Any, what: str, accepted: str = "a number") -> float:
    """Returns a number, possibly NaN; infinity for integers beyond float64. Raises TypeError
    otherwise."""
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError  # float() would convert texts
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf
    except (TypeError, ValueError):
        raise TypeError(f"{what} must be {accepted}, not {value!r}") from None


def as_size(value: Any) -> tuple[int, int]:
    """Returns width and height in pixels."""
    if as_array(value, "size").shape != (2,):
        raise ValueError(f"size must be a width and a height, not {value!r}")
    width, height = (as_integer(v, "size", 1, 65536) for v in value)
    return width, height


def as_crop(value: Any, size: tuple[int, int]) -> tuple[int, int, int, int]:
    """Returns x0, y0, x1, y1 of a part of a picture of this size, which must not be empty."""
    if as_array(value, "crop").shape != (4,):
        raise ValueError(f"crop must be (x0, y0, x1, y1), not {value!r}")
    x0, y0, x1, y1 = (as_integer(v, "crop", -MOST, MOST) for v in value)
    width, height = size
    if not (0 <= x0 < x1 <= width and 0 <= y0 < y1 <= height):
        raise ValueError(
            f"crop must be (x0, y0, x1, y1) with 0 <= x0 < x1 <= {width} and "
            f"0 <= y0 < y1 <= {height}, not {value!r}"
        )
    return x0, y0, x1, y1


def as_text(value: Any, what: str) -> str:
    """Returns a str without surrogates, which C++ code can't read. Raises TypeError or ValueError
    otherwise."""
    if not isinstance(value, str):
        raise TypeError(f"{what} must be a str, not {value!r}")
    if any("\ud800" <= letter <= "\udfff" for letter in value):
        raise ValueError(f"{what} must not contain surrogates, is {value!r}")
    return value


def as_names(values: Any, what: str) -> list[str]:
    """Returns a list of names without repetitions, from one name or several."""
    try:
        names = [values] if isinstance(values, str) else list(values)
    except TypeError:
        raise TypeError(f"{what} must be a name or several, not {values!r}") from None
    return list(dict.fromkeys(as_text(name, f"a name in {what}") for name in names))


def as_path(value: Any, what: str) -> str:
    """Returns a path as text. Raises TypeError or ValueError for what can't be a path."""
    try:
        path = os.fsdecode(value)
    except TypeError:
        kind = type(value).__name__
        raise TypeError(f"{what} must be a str, bytes or os.PathLike object, not {kind}") from None
    if "\0" in path:
        raise ValueError(f"{what} must not contain null characters, is {path!r}")
    try:
        os.fsencode(path)
    except UnicodeEncodeError as error:
        raise ValueError(f"{what} can't be the name of a file, is {path!r}: {error}") from None
    return path


def as_instance(value: Any, what: str, *kinds: type) -> Any:
    """Returns the value. Raises TypeError if it has none of these types."""
    if not isinstance(value, kinds):
        names = " or ".join(f"microtrace.{kind.__name__}" for kind in kinds)
        raise TypeError(f"{what} must be a {names}, not {type(value).__name__}")
    return value


def as_threads(value: Any, what: str = "threads") -> int:
    """Returns a number of threads; 0 means all processors."""
    return as_integer(value, what, 0, 1024)


def as_vector(value: Any, what: str) -> tuple[float, float, float]:
    """Returns three finite numbers."""
    numbers = as_reals(value, what)
    if numbers.shape != (3,) or not np.isfinite(numbers).all():
        raise ValueError(f"{what} must have 3 finite numbers, not {value!r}")
    x, y, z = map(float, numbers)
    return x, y, z
