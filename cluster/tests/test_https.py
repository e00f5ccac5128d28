"""Inputs from a web server on loopback, over TLS."""

from __future__ import annotations

import datetime
import ipaddress
import ssl
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from conftest import OPTIONS, contents
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID
from distributed import Client

from pointweave_dask import PointweaveError, tiles

#: The certificate is nobody's.
UNCHECKED = {"https": {"ssl": False}}


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:
        pass


@pytest.fixture
def served(scans: Path, tmp_path: Path) -> Iterator[str]:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(_certificate(tmp_path / "server.pem"))
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(scans)))
    server.socket = context.wrap_socket(server.socket, server_side=True)
    serving = threading.Thread(target=server.serve_forever)
    serving.start()
    try:
        yield f"https://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        serving.join()
        server.server_close()


def _certificate(path: Path) -> Path:
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "loopback")])
    now = datetime.datetime.now(datetime.timezone.utc)
    made = x509.CertificateBuilder(
        name, name, key.public_key(), x509.random_serial_number(), now, now + datetime.timedelta(days=1)
    )
    hosts = x509.SubjectAlternativeName([x509.IPAddress(ipaddress.ip_address("127.0.0.1"))])
    signed = made.add_extension(hosts, critical=False).sign(key, hashes.SHA256())
    plain = serialization.NoEncryption()
    pem = key.private_bytes(serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, plain)
    path.write_bytes(pem + signed.public_bytes(serialization.Encoding.PEM))
    return path


def test_scans_from_the_web(client: Client, served: str, plain: dict[str, bytes], tmp_path: Path) -> None:
    urls = [f"{served}/{name}.xyz" for name in "abc"]
    tiles(client, urls, str(tmp_path / "out"), storage_options=UNCHECKED, **OPTIONS)
    assert contents(tmp_path / "out") == plain


def test_a_scan_that_is_not_there_is_one_line(client: Client, served: str, tmp_path: Path) -> None:
    with pytest.raises(PointweaveError) as caught:
        tiles(client, f"{served}/none.xyz", str(tmp_path / "out"), retries=0, storage_options=UNCHECKED, **OPTIONS)
    assert "none.xyz" in caught.value.message
    assert "\n" not in caught.value.message
