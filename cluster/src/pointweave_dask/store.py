"""Where inputs lie and results go: a folder or an object store, by an fsspec URL. A file is there whole or not at all."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
import time
import uuid
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from fsspec.core import split_protocol, url_to_fs

from .cells import Box, copy_cells
from .errors import PointweaveError

T = TypeVar("T")

#: A folder in the output for what is not ready. It is removed at the end, and no scan can have its name.
ASIDE = ".pointweave"

#: Stores that show an object when its upload is complete, and not before.
_SINGLE_PUT = {"s3", "s3a", "gs", "gcs", "abfs", "abfss", "az", "adl", "oss", "oci"}

#: Seconds between tries, beside those of the store's own client.
_PAUSES = (0.1, 0.5, 2, None)

#: Files that move at a time. A task may need hundreds of small ones.
_AT_ONCE = 16

#: fsspec's options by protocol: ``{"s3": {"endpoint_url": "…"}}``.
StorageOptions = Mapping[str, Mapping[str, Any]]


@dataclass(frozen=True)
class Store:
    """A folder, or the objects whose names begin so. It travels to workers as its URL."""

    url: str
    options: StorageOptions = field(default_factory=dict)

    @classmethod
    def at(cls, url: str, options: StorageOptions) -> Store:
        """Of a path that a person typed: workers may have started in another folder."""
        return cls(os.path.abspath(url) if split_protocol(url)[0] is None else url, options)

    def fetch(self, paths: Iterable[str], folder: Path) -> None:
        """Brings files into a local folder, under their paths. Files of a local store are linked, not copied."""
        fs, root = self._open()

        def one(path: str) -> None:
            local = folder / path
            local.parent.mkdir(parents=True, exist_ok=True)
            if is_local(fs):
                local.symlink_to(f"{root}/{path}")
            else:
                tried(fs.get_file, f"{root}/{path}", str(local))

        _at_once(one, paths)

    def fetch_cells(self, tiles: Mapping[str, str], box: Box, folder: Path) -> None:
        """Brings of sorted points of tiles, by their paths, the blocks that meet a box. Files of a local store are linked."""
        fs, root = self._open()
        if is_local(fs):
            self.fetch(tiles, folder)
            return

        def one(path: str) -> None:
            remote, local = f"{root}/{path}", folder / path
            local.parent.mkdir(parents=True, exist_ok=True)

            def read(begin: int, end: int) -> bytes:
                return bytes(tried(fs.cat_file, remote, start=begin, end=end))

            copy_cells(read, tried(fs.size, remote), tiles[path], box, local)

        _at_once(one, tiles)

    def put(self, paths: list[str], folder: Path) -> None:
        """Takes files from a local folder. The last one is put when all others are there: it stands for all of them."""
        fs, root = self._open()

        def one(path: str) -> None:
            if _protocol(fs) in _SINGLE_PUT:
                tried(fs.put_file, str(folder / path), f"{root}/{path}")
            else:
                _put_aside(fs, root, folder / path, path)

        _at_once(one, paths[:-1])
        one(paths[-1])

    def has(self, path: str) -> bool:
        fs, root = self._open()
        return bool(tried(fs.exists, f"{root}/{path}"))

    def files(self) -> set[str]:
        """Paths of all that is there."""
        fs, root = self._open()
        return {path[len(root) + 1 :] for path in tried(fs.find, root)}

    def json(self, path: str) -> Any:
        fs, root = self._open()
        return json.loads(tried(fs.cat_file, f"{root}/{path}"))

    def write(self, path: str, text: str) -> None:
        with tempfile.TemporaryDirectory() as folder:
            local = Path(folder, path)
            local.parent.mkdir(parents=True, exist_ok=True)
            local.write_text(text, encoding="utf-8", newline="")
            self.put([path], Path(folder))

    def remove(self, path: str) -> None:
        """Removes a file or a folder, if it is there."""
        fs, root = self._open()
        with suppress(FileNotFoundError):
            tried(fs.rm, f"{root}/{path}", recursive=True)

    def _open(self) -> tuple[Any, str]:
        return open_url(self.url, self.options)


def tried(call: Callable[..., T], *arguments: Any, **named: Any) -> T:
    """Calls a store, and calls it again after errors that may pass. `PointweaveError` where they do not."""
    for pause in _PAUSES:
        try:
            return call(*arguments, **named)
        except FileNotFoundError:
            raise
        except Exception as error:  # each store has errors of its own
            if pause is None:
                raise PointweaveError("store", _line(error)) from error
            time.sleep(pause)
    raise AssertionError("the last pause is None")


def _at_once(call: Callable[[str], None], paths: Iterable[str]) -> None:
    with ThreadPoolExecutor(_AT_ONCE) as pool:
        list(pool.map(call, paths))


def open_url(url: str, options: StorageOptions) -> tuple[Any, str]:
    """The file system of a URL, and the path in it. Listings are not remembered: other workers write."""
    own = options.get(split_protocol(url)[0] or "file", {})
    fs, path = url_to_fs(url, use_listings_cache=False, **own)
    return fs, path.rstrip("/")


def is_local(fs: Any) -> bool:
    return _protocol(fs) == "file"


def _put_aside(fs: Any, root: str, local: Path, path: str) -> None:
    """Written under another name of the same file system, then renamed. What a killed worker leaves goes with `ASIDE`."""
    aside, remote = f"{root}/{ASIDE}/{uuid.uuid4().hex}", f"{root}/{path}"
    for place in (aside, remote):
        tried(fs.makedirs, os.path.dirname(place), exist_ok=True)
    if is_local(fs):
        tried(shutil.move, local, aside)
        tried(os.replace, aside, remote)
    else:
        tried(fs.put_file, str(local), aside)
        tried(fs.mv, aside, remote)


def _line(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__


def _protocol(fs: Any) -> str:
    return fs.protocol if isinstance(fs.protocol, str) else fs.protocol[0]
