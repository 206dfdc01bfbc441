"""The web server of the page: viser's, kept quiet, and closed to the pages of other sites."""

from __future__ import annotations

import contextlib
import functools
import re
import socket
from collections.abc import Iterator

import rich
import viser
import websockets.asyncio.server
from websockets.typing import Origin

LOOPBACK = ("127.0.0.1", "localhost", "::1")

OWN_PAGES: list[re.Pattern[str] | Origin | None] = [
    re.compile(r"https?://(127\.0\.0\.1|localhost|\[::1\])(:\d+)?"),
    None,  # no browser
]


def start_server(host: str, port: int) -> viser.ViserServer:
    """Serve at `host`, at `port` or the next that is free; 0: any free one. ValueError: `host` cannot be used."""
    _check_host(host)
    rich.reconfigure(quiet=True)  # viser tells of its start and end by rich; the node logs its address itself
    if host not in LOOPBACK:
        return viser.ViserServer(host, port, verbose=False)
    with _only_own_pages():
        return viser.ViserServer(host, port, verbose=False)


def address(server: viser.ViserServer) -> str:
    """Where the page is."""
    host = server.get_host()
    host = {"0.0.0.0": "127.0.0.1", "::": "[::1]", "::1": "[::1]"}.get(host, host)
    return f"http://{host}:{server.get_port()}"


def _check_host(host: str) -> None:
    """Raise where nothing can be bound to `host`: viser would wait for ever."""
    try:
        family, kind, protocol, _, place = socket.getaddrinfo(host or None, 0, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind, protocol) as probe:
            probe.bind(place)
    except (OSError, UnicodeError) as reason:
        raise ValueError(
            f"parameter 'host' is {host!r}: no page can be served there ({reason}); 127.0.0.1 is this machine"
        ) from None


@contextlib.contextmanager
def _only_own_pages() -> Iterator[None]:
    """Have the server that is made meanwhile refuse WebSockets of pages from elsewhere.

    A browser lets every site that its user visits open a WebSocket to 127.0.0.1; without this, any of them could
    move the device. viser does not hand the option through to websockets.
    """
    serve = websockets.asyncio.server.serve
    websockets.asyncio.server.serve = functools.partial(serve, origins=OWN_PAGES)  # type: ignore
    try:
        yield
    finally:
        websockets.asyncio.server.serve = serve  # type: ignore
