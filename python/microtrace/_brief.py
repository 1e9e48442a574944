"""Short texts for interactive sessions."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np


class Brief:
    """Gives a dataclass a repr() that omits defaults and shows the shapes of arrays."""

    def __repr__(self) -> str:
        shown = []
        for item in dataclasses.fields(self):  # type: ignore[arg-type]
            value = getattr(self, item.name)
            default = item.default
            if item.default_factory is not dataclasses.MISSING:
                default = item.default_factory()
            if isinstance(value, type(default)) and not _is_array(value) and value == default:
                continue
            if value is not None or default is dataclasses.MISSING:
                shown.append(f"{item.name}={text(value)}")
        return f"{type(self).__name__}({', '.join(shown)})"


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
