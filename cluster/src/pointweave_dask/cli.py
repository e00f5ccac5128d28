"""`pointweave-dask tiles|reduce|catalogue INPUT… OUT`, with the flags of `pointweave`."""

from __future__ import annotations

import argparse
import logging
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

from distributed import Client, LocalCluster

from . import npm
from .batch import reduce_many
from .catalogue import catalogue
from .errors import PointweaveError
from .tiles import tiles

COMMANDS = {
    "tiles": "scans of any size to a tileset that browsers stream",
    "reduce": "fewer points that stand for all, scan by scan",
    "catalogue": "a folder of scans as a web page of light models",
}
#: Flags of the command line that mean something else here, or nothing.
_OTHERS = {"help", "out", "out-dir", "json", "threads", "jobs", "resume", "keep-work", "tile", "input", "stage"}


def main(argv: Sequence[str] | None = None) -> int:
    """Ends with 0 done, 1 failed, 2 usage, 130 interrupted."""
    words = list(sys.argv[1:] if argv is None else argv)
    for logger in ("distributed", "distributed.client"):
        logging.getLogger(logger).setLevel(logging.CRITICAL)  # what matters is said in one line of our own
    try:
        if not words or words[0] not in COMMANDS:
            return _overview(words)
        command = words.pop(0)
        typed = vars(_parser(command).parse_intermixed_args(words))
        said = {name: value for name, value in typed.items() if value is not None}
        with _client(said.pop("scheduler", None), said.pop("jobs", None)) as client:
            return _run(command, client, said)
    except PointweaveError as error:
        _say(error.message)
        return 2 if error.code == "usage" else 1
    except KeyboardInterrupt:
        _say("interrupted: what is done stays")
        return 130


def _overview(words: list[str]) -> int:
    lines = [f"  pointweave-dask {command} INPUT… OUT    {does}" for command, does in COMMANDS.items()]
    print("Commands, each with --help", *lines, sep="\n", file=sys.stdout if words in ([], ["--help"]) else sys.stderr)
    return 0 if words in ([], ["--help"]) else 2


def _parser(command: str) -> argparse.ArgumentParser:
    flags = npm.ask("flags", command)
    parser = argparse.ArgumentParser(
        prog=f"pointweave-dask {command}",
        description=f"{COMMANDS[command]}. Inputs and OUT are paths or URLs that fsspec knows, such as s3://bucket/scans.",
        epilog=f"`pointweave {command} --help` explains the flags that stand here without words.",
        allow_abbrev=False,
    )
    parser.add_argument("inputs", nargs="+", metavar="INPUT", help="files, folders and patterns (in quotes)")
    parser.add_argument("output", metavar="OUT", help="the folder where results go")
    parser.add_argument("--scheduler", metavar="URL", help="of a Dask cluster, tcp://…; default: workers on this machine")
    parser.add_argument("--jobs", type=int, metavar="N", help="workers on this machine; default: one a core")
    parser.add_argument("--retries", type=int, default=3, metavar="N", help="how often a task is tried again; default: 3")
    if command != "catalogue":
        parser.add_argument("--resume", action="store_true", help="go on with what an earlier run left")
    if command == "tiles":
        parser.add_argument("--keep-work", action="store_true", help="leave OUT/work, to look at")
    for name, flag in flags.items():
        if name not in _OTHERS and not name.startswith("no-"):
            _add(parser, name, flag, f"no-{name}" in flags)
        elif name.startswith("no-") and name[3:] not in flags:
            parser.add_argument(f"--{name}", action="store_const", const=False, dest=name[3:].replace("-", "_"))
    return parser


def _add(parser: argparse.ArgumentParser, name: str, flag: dict[str, Any], both: bool) -> None:
    if flag["type"] == "string":
        parser.add_argument(f"--{name}", action="append" if flag.get("multiple") else "store", metavar="VALUE")
    else:
        action: Any = argparse.BooleanOptionalAction if both else "store_true"
        parser.add_argument(f"--{name}", action=action, default=None)


@contextmanager
def _client(scheduler: str | None, jobs: int | None) -> Iterator[Client]:
    if scheduler is not None:
        try:
            client = Client(scheduler, timeout=30)
        except OSError as error:
            raise PointweaveError("cancelled", f"there is no scheduler at {scheduler}: {error}") from None
        with client:
            yield client
        return
    with _workers(jobs or os.cpu_count() or 1) as cluster, Client(cluster) as client:
        if find_spec("bokeh") is not None:
            _say(f"dashboard at {cluster.dashboard_link}")
        yield client


def _workers(count: int) -> LocalCluster:
    """Processes of one thread each. The dashboard is on loopback, at a port that is free."""
    local = {"dashboard_address": "127.0.0.1:0", "silence_logs": logging.CRITICAL}
    # They inherit this: Ctrl-C is for the client, which ends them.
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        return LocalCluster(n_workers=count, threads_per_worker=1, **local)
    finally:
        signal.signal(signal.SIGINT, before)


def _run(command: str, client: Client, said: dict[str, Any]) -> int:
    progress = Terminal()
    if command == "tiles":
        manifest = tiles(client, progress=progress, **said)
        points, reduced, count = (manifest[name] for name in ("points", "reduced", "tiles"))
        _say(f"{said['output']}: {points:,} points to {reduced:,} in {count} tiles")
        return 0
    if command == "reduce":
        entries = reduce_many(client, progress=progress, **said)
    else:
        entries = catalogue(client, progress=progress, **said)
    failed = [entry for entry in entries if "error" in entry]
    for entry in failed:
        _say(f"{entry.get('source', entry.get('input'))}: {entry['error']['message']}")
    _say(f"{said['output']}: {len(entries) - len(failed)} of {len(entries)} done, {len(failed)} failed")
    return 1 if failed else 0


class Terminal:
    """Stage, done and all: one line that changes on a terminal, one line a stage elsewhere."""

    def __call__(self, stage: str, done: int, total: int) -> None:
        if sys.stderr.isatty():
            print(f"\r{stage} {done}/{total}\x1b[K", end="\n" if done == total else "", file=sys.stderr, flush=True)
        elif done == total:
            _say(f"{stage} {done}/{total}")


def _say(line: str) -> None:
    print(f"pointweave-dask: {line}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
