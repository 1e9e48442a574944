"""Folders on file systems of fsspec."""

from __future__ import annotations

import inspect
import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import fsspec  # type: ignore[import-untyped,unused-ignore]


class Store:
    """A folder that a URL names."""

    def __init__(self, url: str, options: Mapping[str, Any]) -> None:
        self.url = url
        self.options = dict(options)
        with self._failures():
            self._files, self._root = fsspec.core.url_to_fs(url, **self.options)
        protocol = self._files.protocol
        protocols = (protocol,) if isinstance(protocol, str) else protocol
        #: The folder's path if it is a folder of this machine.
        self.local: Path | None = Path(self._root) if "file" in protocols else None

    def __reduce__(self) -> Any:
        # Other machines have other working folders.
        return (Store, (self.url if self.local is None else str(self.local), self.options))

    @contextmanager
    def _failures(self) -> Iterator[None]:
        """Makes OSErrors of the errors of storage clients, which have their own types, and lets all
        name the folder."""
        try:
            yield
        except OSError as error:
            if self.url in str(error):
                raise
            message = f"{self.url}: {error}"
            if error.errno is not None:
                raise OSError(error.errno, message) from error
            kind = type(error) if type(error).__module__ == "builtins" else OSError
            raise kind(message) from error
        except (ImportError, ValueError):
            raise
        except Exception as error:
            raise OSError(f"{self.url}: {type(error).__name__}: {error}") from error

    def _path(self, name: str) -> str:
        return f"{self._root.rstrip('/')}/{name}"

    def read(self, name: str) -> bytes | None:
        """Returns the bytes of a file; None if it doesn't exist."""
        with self._failures():
            try:
                return bytes(self._files.cat_file(self._path(name)))
            except FileNotFoundError:
                return None

    def is_empty(self) -> bool:
        """Returns True if the folder has no files or doesn't exist."""
        with self._failures():
            self._files.invalidate_cache()
            # Some stores have a file without a name for a folder.
            return not any(any(files) for _, _, files in self._files.walk(self._root))

    def names(self, subfolder: str) -> set[str]:
        """Returns the names of the files in a subfolder."""
        with self._failures():
            self._files.invalidate_cache()
            start = len(self._path(""))
            return {path[start:] for path in self._files.find(self._path(subfolder))}

    def create(self, name: str, data: bytes) -> bool:
        """Stores a file unless it exists; returns False if it does. Stores that can't refuse to
        replace a file replace it."""
        path = self._path(name)
        parameters = inspect.signature(self._files.pipe_file).parameters
        mode = {"mode": "create"} if "mode" in parameters else {}
        with self._failures():
            try:
                self._files.pipe_file(path, data, **mode)
            except NotImplementedError:
                self._files.pipe_file(path, data)
            except OSError:
                # Clients of stores report existing files by several kinds of errors.
                self._files.invalidate_cache()
                if not mode or not self._files.exists(path):
                    raise
                return False
        return True

    def upload(self, folder: Path, names: Sequence[str]) -> None:
        """Stores files of a folder of this machine under the same names, several at a time."""
        with self._failures():
            self._files.put([str(folder / n) for n in names], [self._path(n) for n in names])

    def download(self, subfolder: str, folder: Path) -> None:
        """Copies the files of a subfolder to the same names in a folder of this machine."""
        with self._failures():
            names = sorted(self.names(subfolder))
            for parent in {(folder / name).parent for name in names}:
                parent.mkdir(parents=True, exist_ok=True)
            if names:
                paths = [self._path(name) for name in names]
                self._files.get(paths, [str(folder / name) for name in names])

    def is_whole(self, record: str) -> bool:
        """Returns True if a view has a record and all its files have the right sizes."""
        text = self.read(record)
        if text is None:
            return False
        try:  # a worker that was killed, or a power failure, can leave a part of a record
            files = [(file["name"], file["size"]) for file in json.loads(text)["files"]]
        except (ValueError, KeyError, TypeError):
            return False
        for name, size in files:
            with self._failures():
                try:
                    if self._files.size(self._path(name)) != size:
                        return False
                except FileNotFoundError:
                    return False
        return True
