"""Files, folders and patterns to the scans that they mean."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from posixpath import basename
from typing import Any

from fsspec.core import split_protocol

from . import npm
from .errors import PointweaveError
from .store import StorageOptions, is_local, open_url, tried


@dataclass(frozen=True)
class Scan:
    url: str
    #: Its path in the folder that was named, or its file name.
    name: str
    #: Its size, where the store tells it.
    bytes: int | None


def scans_in(inputs: str | Iterable[str], options: StorageOptions) -> list[Scan]:
    """The scans of URLs: of files, of folders with all folders within, and of patterns such as ``s3://in/*.laz``."""
    urls = [inputs] if isinstance(inputs, str) else list(inputs)
    found = [scan for url in urls for scan in _scans_of(url, options)]
    if not found:
        raise PointweaveError("usage", f"there are no scans in {', '.join(urls)}")
    return found


def _scans_of(url: str, options: StorageOptions) -> list[Scan]:
    if split_protocol(url)[0] in ("http", "https"):
        return [Scan(url, basename(url), None)]
    fs, path = open_url(url, options)
    if any(mark in path for mark in "*?["):
        found = tried(fs.glob, path, detail=True)
        names = {file: basename(file) for file in sorted(found)}
    elif tried(fs.isdir, path):
        found = tried(fs.find, path, detail=True)
        within = sorted(file[len(path) + 1 :] for file in found)
        names = {f"{path}/{name}": name for name in npm.ask("scans", within)}
    else:
        names = {path: basename(path)}
        found = {path: _info(fs, path, url)}
    return [Scan(file if is_local(fs) else fs.unstrip_protocol(file), name, found[file]["size"]) for file, name in names.items()]


def _info(fs: Any, path: str, url: str) -> Any:
    try:
        return tried(fs.info, path)
    except FileNotFoundError:
        raise PointweaveError("usage", f"'{url}': there is no such file or folder") from None


def bring(scan: Scan, options: StorageOptions, folder: Path) -> None:
    """Brings a scan into a local folder, under its name. One that lies on a local disk is linked, not copied."""
    fs, path = open_url(scan.url, options)
    local = folder / scan.name
    local.parent.mkdir(parents=True, exist_ok=True)
    try:
        if not is_local(fs):
            tried(fs.get_file, path, str(local))
        elif fs.exists(path):
            local.symlink_to(path)
        else:
            raise FileNotFoundError
    except FileNotFoundError:
        raise PointweaveError("failed", f"{scan.url}: there is no such file") from None
