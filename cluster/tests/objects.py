"""An object store on loopback: moto's S3, behind a door that answers requests with errors."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from moto.server import DomainDispatcherApplication, create_backend_app
from werkzeug.serving import make_server

BUSY = b"<Error><Code>InternalError</Code><Message>an error of the store</Message></Error>"


class Door:
    """Passes requests on, but for those that `fails` chooses by their number, method and path."""

    def __init__(self) -> None:
        self.app = DomainDispatcherApplication(create_backend_app)
        self.fails: Callable[[int, str, str], bool] = lambda number, method, path: False
        self.requests = self.errors = 0
        self.lock = threading.Lock()

    def __call__(self, environ: dict[str, Any], start_response: Callable[..., Any]) -> Iterable[bytes]:
        with self.lock:
            self.requests += 1
            failed = self.fails(self.requests, environ["REQUEST_METHOD"], environ["PATH_INFO"])
            self.errors += failed
        if not failed:
            answer: Iterable[bytes] = self.app(environ, start_response)
            return answer
        environ["wsgi.input"].read(int(environ.get("CONTENT_LENGTH") or 0))
        start_response("500 Internal Server Error", [("Content-Type", "application/xml"), ("Content-Length", str(len(BUSY)))])
        return [b"" if environ["REQUEST_METHOD"] == "HEAD" else BUSY]


@contextmanager
def objects() -> Iterator[tuple[str, Door]]:
    door = Door()
    server = make_server("127.0.0.1", 0, door, threaded=True)
    serving = threading.Thread(target=server.serve_forever)
    serving.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}", door
    finally:
        server.shutdown()
        serving.join()
