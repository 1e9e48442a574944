"""What the classes of scenes have in common."""

from __future__ import annotations

import dataclasses
import difflib
from typing import Any

import numpy as np

Vector = tuple[float, float, float]


class Brief:
    """Gives a dataclass a repr() that omits defaults and shows the shapes of arrays. Refuses
    attributes that aren't fields, because a misspelled one would have no effect."""

    def __setattr__(self, name: str, value: Any) -> None:
        fields = getattr(self, "__dataclass_fields__", {})
        # Classes that others derive may have attributes of their own.
        is_ours = type(self).__module__.startswith(f"{__package__}.")
        if is_ours and name not in fields and not hasattr(type(self), name):
            near = difflib.get_close_matches(name, fields, 1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise AttributeError(f"{type(self).__name__} has no attribute {name!r}{hint}")
        super().__setattr__(name, value)

    def __repr__(self) -> str:
        shown = []
        for item in dataclasses.fields(self):  # type: ignore[arg-type]
            value = getattr(self, item.name)
            default = item.default
            if item.default_factory is not dataclasses.MISSING:
                default = item.default_factory()
            if isinstance(value, type(default)) and _is_equal(value, default):
                continue
            if value is not None or default is dataclasses.MISSING:
                shown.append(f"{item.name}={text(value)}")
        return f"{type(self).__name__}({', '.join(shown)})"


def _is_equal(value: Any, default: Any) -> bool:
    """Returns False for arrays, and for tuples of arrays, which have no single truth value."""
    try:
        return not _is_array(value) and bool(value == default)
    except ValueError:
        return False


def _is_array(value: Any) -> bool:
    return isinstance(value, np.ndarray)


def text(value: Any) -> str:
    """Returns a short text for a value."""
    if _is_array(value):
        return f"<{value.dtype} {value.shape}>"
    if isinstance(value, float):
        return f"{value:.7g}"
    if isinstance(value, tuple):
        return f"({', '.join(map(text, value))}{',' if len(value) == 1 else ''})"
    if isinstance(value, list):
        few = ", ".join(map(text, value[:3]))
        return f"[{few}, ... {len(value)} in all]" if len(value) > 3 else f"[{few}]"
    return repr(value)
