"""Errors and warnings. Their texts are those of the program microtrace."""

from __future__ import annotations

import errno
import os
import sys
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Diagnostic:
    """A message about a position in a file. Unknown members are empty or 0."""

    file: str  #: path as the user gave it
    line: int  #: counted from 1
    column: int  #: counted in bytes from 1
    pointer: str  #: JSON pointer to the value (RFC 6901)
    message: str  #: the problem and the remedy
    text: str  #: the whole message, with position and source line


class Error(Exception):
    """The base class of microtrace's exceptions."""

    diagnostic: Diagnostic

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        message = super().__str__()
        self.diagnostic = Diagnostic("", 0, 0, "", message, message)


class SceneError(Error, ValueError):
    """A scene violates its format or its rules."""


class UsageError(Error, ValueError):
    """An argument is invalid."""


class UnsupportedError(Error, ValueError):
    """A scene requires an unsupported feature."""


class FileError(Error, OSError):
    """A file can't be read or written. `errno`, `strerror` and `filename` are None if unknown."""

    def __str__(self) -> str:
        return self.diagnostic.text

    def __reduce__(self) -> tuple[Any, ...]:
        names = ("errno", "strerror", "filename")
        known = {name: getattr(self, name) for name in names}
        return (type(self), self.args, {**self.__dict__, **known})


class MissingFileError(FileError, FileNotFoundError):
    """There is no such file or folder."""


class LimitError(Error, MemoryError):
    """Memory or another documented limit is exceeded."""


class CanceledError(Error):
    """A callback asked to stop."""


class SceneWarning(UserWarning):
    """A warning about a scene file: an oddity, an ignored feature or a repaired violation."""

    diagnostic: Diagnostic

    def __init__(self, *args: Any) -> None:
        given = args[0] if args else None
        if isinstance(given, Diagnostic):
            args = (given.text, *args[1:])
        super().__init__(*args)
        message = str(self)
        plain = Diagnostic("", 0, 0, "", message, message)
        self.diagnostic = given if isinstance(given, Diagnostic) else plain


#: Maps the program's exit codes to exceptions for the same failures.
_CLASSES: dict[int, type[Error]] = {
    2: UsageError,
    3: SceneError,
    4: UnsupportedError,
    5: FileError,
    6: LimitError,
    7: CanceledError,
}


def error_of(code: int, diagnostic: Diagnostic, number: int = 0) -> Error:
    """Makes the exception that corresponds to an exit code of the program.

    `number` is the value of errno, or 0 if no call of the system failed.
    """
    kind = _CLASSES.get(code, Error)
    if kind is FileError and number == errno.ENOENT:
        kind = MissingFileError
    error = kind()
    set_diagnostic(error, diagnostic)
    if isinstance(error, FileError) and number != 0:
        error.errno, error.strerror = number, os.strerror(number)
    return error


def failure(code: int, message: str, file: str = "") -> Error:
    """Makes the exception with this message, about a file or none."""
    return error_of(code, Diagnostic(file, 0, 0, "", message, message))


def set_diagnostic(error: Error, diagnostic: Diagnostic) -> None:
    """Makes an error say what a diagnostic says."""
    error.args = (diagnostic.text,)
    error.diagnostic = diagnostic
    # With a pointer, the message is about a file that this one names.
    if isinstance(error, FileError) and diagnostic.pointer == "":
        error.filename = diagnostic.file or None


def warn_caller(warning: Warning) -> None:
    """Issues a warning that refers to the caller's line outside this package."""
    package = os.path.join(Path(__file__).parent, "")
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(package):
        level, frame = level + 1, frame.f_back
    warnings.warn(warning, stacklevel=level)


def warn(diagnostics: Iterable[Diagnostic]) -> None:
    """Issues a warning for each diagnostic."""
    for diagnostic in diagnostics:
        warn_caller(SceneWarning(diagnostic))
