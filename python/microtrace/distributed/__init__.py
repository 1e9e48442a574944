"""Renders on the workers of a Dask cluster. The results have the bytes of one run on one machine.

Install it by `pip install '.[distributed]'` in a clone of the repository, with the same version of
microtrace on the client and on all workers.
"""

from __future__ import annotations

try:
    import distributed as _distributed  # noqa: F401
    import fsspec as _fsspec  # type: ignore[import-untyped,unused-ignore]  # noqa: F401
except ImportError as _error:
    raise ImportError(
        f"microtrace.distributed needs the package {_error.name}; "
        "install it by pip install '.[distributed]' in a clone of microtrace's repository",
        name=_error.name,
    ) from _error

from .datasets import Summary, dataset
from .pictures import render

__all__ = ["Summary", "dataset", "render"]
