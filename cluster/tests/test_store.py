"""Inputs and output in an object store, which works, answers with errors, or is gone."""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import s3fs
from conftest import OPTIONS
from distributed import Client
from objects import Door, objects

from pointweave_dask import PointweaveError, tiles
from pointweave_dask.store import Store


@pytest.fixture(scope="module")
def served() -> Iterator[tuple[dict[str, Any], Door]]:
    """How to reach the store, and its door."""
    with objects() as (url, door):
        # The client's own tries are not what is tested.
        retries = {"retries": {"max_attempts": 0}}
        yield {"key": "test", "secret": "test", "endpoint_url": url, "config_kwargs": retries}, door


@pytest.fixture
def bucket(served: tuple[dict[str, Any], Door], scans: Path) -> str:
    """A new bucket with the scans in it."""
    options, door = served
    door.fails = lambda number, method, path: False
    name = f"bucket-{uuid.uuid4().hex}"
    fs = s3fs.S3FileSystem(**options)
    fs.mkdir(name)
    fs.put(f"{scans}/", f"{name}/in/", recursive=True)
    return name


def test_an_object_store_that_returns_errors(
    client: Client, served: tuple[dict[str, Any], Door], bucket: str, plain: dict[str, bytes]
) -> None:
    options, door = served
    door.fails = lambda number, method, path: number % 7 == 0
    before = door.errors
    tiles(client, f"s3://{bucket}/in/*.xyz", f"s3://{bucket}/out", storage_options={"s3": options}, **OPTIONS)
    assert door.errors > before + 10
    door.fails = lambda number, method, path: False
    fs = s3fs.S3FileSystem(**options, use_listings_cache=False)
    made = {path.removeprefix(f"{bucket}/out/"): fs.cat_file(path) for path in fs.find(f"{bucket}/out")}
    assert made == plain


def test_a_store_that_stays_broken_is_one_line(client: Client, served: tuple[dict[str, Any], Door], bucket: str) -> None:
    options, door = served
    door.fails = lambda number, method, path: method == "PUT" and "work/density" in path
    with pytest.raises(PointweaveError) as caught:
        tiles(client, f"s3://{bucket}/in", f"s3://{bucket}/out", retries=0, storage_options={"s3": options}, **OPTIONS)
    assert caught.value.code == "store"
    assert caught.value.message.startswith("density all: ")
    assert "\n" not in caught.value.message


def test_a_file_is_whole_or_not_there(tmp_path: Path) -> None:
    """The last file stands for all; none is seen under its name before it is whole."""
    store = Store.at(str(tmp_path / "store"), {})
    for name in ("a", "deep/b"):
        (tmp_path / "made" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "made" / name).write_text(name)
    store.put(["a", "deep/b"], tmp_path / "made")
    assert store.files() == {"a", "deep/b"}
    with pytest.raises(FileNotFoundError):
        store.put(["c", "a"], tmp_path / "made")
    assert not store.has("c")
    store.fetch(["deep/b"], tmp_path / "scratch")
    assert (tmp_path / "scratch/deep/b").read_text() == "deep/b"
