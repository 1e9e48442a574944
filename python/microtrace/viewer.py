"""The page that shows a scene in a notebook or a browser."""

from __future__ import annotations

import os
import shlex
import weakref
import webbrowser
from collections.abc import Sequence
from html import escape
from types import TracebackType

from microtrace_program import find_denoiser

from . import _core
from ._arrays import as_text


class View:
    """A page on 127.0.0.1 that shows a scene; see PreparedScene.view().

    Notebooks show the page as the value of a cell. A background thread serves it until close() is
    called, this object is deleted, or Python exits.
    """

    def __init__(
        self,
        core: _core.Prepared,
        name: str,
        words: list[str],
        port: int,
        allow_host: str,
        height: int,
    ) -> None:
        find_denoiser()  # the page offers to denoise
        self._core = _core.Viewer(core, name, words, port, allow_host)
        self._height = height
        # A forked process has no thread that serves the page.
        self._close = weakref.finalize(self, _close, self._core, os.getpid())

    @property
    def url(self) -> str:
        """The address of the page. It contains a token, without which requests are refused."""
        return self._core.address

    @property
    def port(self) -> int:
        """The port of 127.0.0.1."""
        return self._core.port

    def open(self) -> None:
        """Opens the page in the default browser."""
        webbrowser.open(self.url)

    def close(self) -> None:
        """Stops serving the page. Calling it again has no effect."""
        self._close()

    def __enter__(self) -> View:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        state = "closed" if self._core.is_closed else self.url
        return f"View({state})"

    def _repr_html_(self) -> str | None:
        if self._core.is_closed:
            return None
        return (
            f'<iframe src="{escape(self.url)}" width="100%" height="{self._height}" '
            'allow="clipboard-write" style="border: 0"></iframe>'
        )


def _close(core: _core.Viewer, process: int) -> None:
    if os.getpid() == process:
        core.close()


def words_of(options: str | Sequence[str]) -> list[str]:
    """Returns the words of options of the command line."""
    if isinstance(options, str):
        as_text(options, "options")
        try:
            return shlex.split(options)
        except ValueError as error:
            raise ValueError(f"options can't be divided into words: {error}") from None
    try:
        if isinstance(options, bytes):
            raise TypeError  # its items are numbers
        return [as_text(str(word), "options") for word in options]
    except TypeError:
        raise TypeError(f"options must be a str or a list, not {options!r}") from None
