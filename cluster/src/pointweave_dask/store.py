"""Where inputs lie and results go: a folder or an object store, by an fsspec URL. A file is there whole or not at all."""

from __future__ import annotations

import json
import os
import shutil
import uuid
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fsspec.core import split_protocol, url_to_fs

#: Under the output: what only the work needs. It is removed at the end.
WORK = "work"

#: Stores that show an object when its upload is complete, and not before.
_SINGLE_PUT = {"s3", "s3a", "gs", "gcs", "abfs", "abfss", "az", "adl", "oss", "oci"}

#: fsspec's options by protocol: ``{"s3": {"endpoint_url": "…"}}``.
StorageOptions = Mapping[str, Mapping[str, Any]]


@dataclass(frozen=True)
class Store:
    """A folder, or the objects whose names begin so. It travels to workers as its URL."""

    url: str
    options: StorageOptions = field(default_factory=dict)

    def fetch(self, paths: Iterable[str], folder: Path) -> None:
        """Brings files into a local folder, under their paths. Files of a local store are linked, not copied."""
        fs, root = self._open()
        pairs = [(f"{root}/{path}", folder / path) for path in paths]
        for _, local in pairs:
            local.parent.mkdir(parents=True, exist_ok=True)
        if is_local(fs):
            for remote, local in pairs:
                local.symlink_to(remote)
        elif pairs:
            fs.get([remote for remote, _ in pairs], [str(local) for _, local in pairs])

    def put(self, paths: list[str], folder: Path) -> None:
        """Takes files from a local folder. The last one is put when all others are there: it stands for all of them."""
        fs, root = self._open()
        *first, last = paths
        for batch in (first, [last]):
            if _protocol(fs) in _SINGLE_PUT:
                if batch:
                    fs.put([str(folder / path) for path in batch], [f"{root}/{path}" for path in batch])
            else:
                for path in batch:
                    _put_aside(fs, root, folder / path, path)

    def has(self, path: str) -> bool:
        fs, root = self._open()
        return bool(fs.exists(f"{root}/{path}"))

    def files(self) -> set[str]:
        """Paths of all that is there."""
        fs, root = self._open()
        return {path[len(root) + 1 :] for path in fs.find(root)}

    def json(self, path: str) -> Any:
        fs, root = self._open()
        return json.loads(fs.cat_file(f"{root}/{path}"))

    def remove(self, path: str) -> None:
        """Removes a file or a folder, if it is there."""
        fs, root = self._open()
        if fs.exists(f"{root}/{path}"):
            fs.rm(f"{root}/{path}", recursive=True)

    def _open(self) -> tuple[Any, str]:
        return open_url(self.url, self.options)


def open_url(url: str, options: StorageOptions) -> tuple[Any, str]:
    """The file system of a URL, and the path in it. Listings are not remembered: other workers write."""
    own = options.get(split_protocol(url)[0] or "file", {})
    fs, path = url_to_fs(url, use_listings_cache=False, **own)
    return fs, path.rstrip("/")


def is_local(fs: Any) -> bool:
    return _protocol(fs) == "file"


def _put_aside(fs: Any, root: str, local: Path, path: str) -> None:
    """Written under another name of the same file system, then renamed. What a killed worker leaves lies in `work`."""
    aside, remote = f"{root}/{WORK}/part/{uuid.uuid4().hex}", f"{root}/{path}"
    for place in (aside, remote):
        fs.makedirs(os.path.dirname(place), exist_ok=True)
    if is_local(fs):
        shutil.move(local, aside)
        os.replace(aside, remote)
    else:
        fs.put_file(str(local), aside)
        fs.mv(aside, remote)


def _protocol(fs: Any) -> str:
    return fs.protocol if isinstance(fs.protocol, str) else fs.protocol[0]
