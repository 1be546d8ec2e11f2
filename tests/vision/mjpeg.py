"""A camera on the loopback that streams JPEG over HTTP, as cheap network cameras do."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Event, Thread

import cv2
import numpy as np

WIDTH, HEIGHT = 96, 64


class Stream(BaseHTTPRequestHandler):
    """Sends grey frames, each brighter than the one before, at 50 Hz."""

    server: Server

    def do_GET(self) -> None:
        self.server.over.wait(self.server.late)
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
        self.end_headers()
        for k in range(self.server.frames):
            _, jpeg = cv2.imencode(".jpg", np.full((HEIGHT, WIDTH, 3), 2 * k + 10, np.uint8))
            head = f"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {jpeg.size}\r\n\r\n"
            self.wfile.write(head.encode() + jpeg.tobytes() + b"\r\n")
            self.server.over.wait(0.02)
        if self.server.stalls:
            self.server.over.wait(30.0)

    def log_message(self, *_: object) -> None:
        pass


class Server(ThreadingHTTPServer):
    """frames: so many are sent, the first after `late` s; stalls: then the line stays open."""

    daemon_threads = True

    def __init__(self, frames: int, stalls: bool, late: float) -> None:
        super().__init__(("127.0.0.1", 0), Stream)
        self.frames, self.stalls, self.late, self.over = frames, stalls, late, Event()

    def handle_error(self, *_: object) -> None:
        """A reader that goes away is no error."""


@contextmanager
def camera(frames: int = 60, stalls: bool = False, late: float = 0.0) -> Iterator[str]:
    """Yields the URL of a camera."""
    with Server(frames, stalls, late) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        try:
            yield f"http://127.0.0.1:{server.server_address[1]}/stream.mjpg"
        finally:
            server.over.set()
            server.shutdown()
