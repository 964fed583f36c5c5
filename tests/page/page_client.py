"""A browser's part for tests: HTTP requests, and a WebSocket (RFC 6455) that also sends what no browser would."""

import base64
import json
import os
import select
import socket
import ssl
import struct
import time
import urllib.error
import urllib.request

PATIENCE_SECONDS = 20
PART = struct.Struct("<BBHIQIHHHHHHI")
JPEG_PART, H264_PART, CURSOR_PART, PNG_PART = 1, 2, 3, 4
KEY, STILL, HIDDEN = 1, 4, 8
PART_NAMES = ("version", "kind", "flags", "stream", "frame", "lastInput", "x", "y", "w", "h", "pictureWidth", "pictureHeight", "bytes")


def request(url, path, token=None, method="GET", body=None, headers=None):
    """Returns (status, headers, bytes)."""
    all_headers = dict(headers or {})
    if token is not None:
        all_headers["Authorization"] = "Bearer " + token
    data = body if body is None or isinstance(body, bytes) else json.dumps(body).encode()
    wanted = urllib.request.Request(url.rstrip("/") + path, data=data, headers=all_headers, method=method)
    context = ssl._create_unverified_context() if url.startswith("https") else None  # the certificate is its own
    try:
        with urllib.request.urlopen(wanted, timeout=PATIENCE_SECONDS, context=context) as reply:
            return reply.status, reply.headers, reply.read()
    except urllib.error.HTTPError as error:
        return error.code, error.headers, error.read()


class WebSocket:
    """A context manager. Messages are dictionaries (text) or lists of (header, payload) (binary)."""

    def __init__(self, url, origin=None, host=None, protocol="mural.v1"):
        scheme, _, rest = url.partition("://")
        name, _, port = rest.strip("/").rpartition(":")
        self.closed = None  # (code, reason) after the close frame of the page
        self.received = b""
        self.kind, self.fragments = 1, b""  # of the message that is being received
        self.messages = []
        self.cursors = []  # that came between pictures
        self.heard, self.said = [], []  # all text messages, from the page and to it
        self.socket = socket.create_connection((name, int(port)), PATIENCE_SECONDS)
        if scheme == "https":
            self.socket = ssl._create_unverified_context().wrap_socket(self.socket)
        lines = ["GET /ws HTTP/1.1", "Host: " + (host or name + ":" + port), "Upgrade: websocket", "Connection: Upgrade",
                 "Sec-WebSocket-Version: 13", "Sec-WebSocket-Key: " + base64.b64encode(os.urandom(16)).decode()]
        lines += ["Origin: " + origin] if origin else []
        lines += ["Sec-WebSocket-Protocol: " + protocol] if protocol else []
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        while b"\r\n\r\n" not in self.received:
            part = self.socket.recv(4096)
            if not part:
                break
            self.received += part
        head, _, self.received = self.received.partition(b"\r\n\r\n")
        self.status = int(head.split()[1]) if head else 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def frame(self, code, payload):
        mask = os.urandom(4)
        size = len(payload)
        length = bytes([0x80 | size]) if size < 126 else struct.pack(">BH", 0xfe, size) if size < 65536 else struct.pack(">BQ", 0xff, size)
        masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))
        try:
            self.socket.sendall(bytes([0x80 | code]) + length + mask + masked)
        except OSError:
            self.closed = self.closed or (0, "lost")

    def send(self, message):
        self.said.append(message)
        self.frame(1, (message if isinstance(message, str) else json.dumps(message)).encode())

    def _take_frames(self):
        while len(self.received) >= 2:
            isLast, code, size, at = self.received[0] & 0x80, self.received[0] & 15, self.received[1] & 127, 2
            if size >= 126:
                width = 2 if size == 126 else 8
                if len(self.received) < 2 + width:
                    return
                size, at = int.from_bytes(self.received[2:2 + width], "big"), 2 + width
            if len(self.received) < at + size:
                return
            payload, self.received = self.received[at:at + size], self.received[at + size:]
            if code in (0, 1, 2):  # a message of the server may consist of several frames
                self.kind = code or self.kind
                self.fragments += payload
                if not isLast:
                    continue
                self.messages.append(json.loads(self.fragments) if self.kind == 1 else parts_of(self.fragments))
                if self.kind == 1:
                    self.heard.append(self.messages[-1])
                self.fragments = b""
            elif code == 8:
                self.closed = (int.from_bytes(payload[:2], "big"), payload[2:].decode())
            elif code == 9:
                self.frame(10, payload)

    def receive(self, accept, seconds=PATIENCE_SECONDS):
        """Returns the first message that `accept` accepts, or None after the time or the close."""
        deadline = time.monotonic() + seconds
        while True:
            for at, message in enumerate(self.messages):
                if accept(message):
                    del self.messages[:at + 1]
                    return message
            del self.messages[:]
            left = deadline - time.monotonic()
            if self.closed or left <= 0:
                return None
            pending = isinstance(self.socket, ssl.SSLSocket) and self.socket.pending()
            if not pending and not select.select([self.socket], [], [], left)[0]:
                return None
            try:
                part = self.socket.recv(1 << 20)
            except OSError:
                part = b""
            if not part:
                self.closed = self.closed or (0, "lost")
            self.received += part
            self._take_frames()

    def close_code(self, seconds=PATIENCE_SECONDS):
        """Returns the code of the page's close frame; 0: the connection was lost; None: it stays open."""
        self.receive(lambda _: False, seconds)
        return self.closed and self.closed[0]

    def hello(self, token, name="test", h264=False):
        self.send({"hello": {"token": token, "name": name, "canUse": {"h264": h264}, "px": [1280, 720]}})
        message = self.receive(lambda m: "welcome" in m)
        return message and message["welcome"]

    def ask(self, operation, arguments=None, number=1):
        """Returns the reply to a request."""
        self.send({"id": number, "op": operation, "args": arguments or {}})
        return self.receive(lambda m: isinstance(m, dict) and m.get("id") == number)

    def pictures(self, count, seconds=PATIENCE_SECONDS):
        """Receives and acknowledges pictures."""
        found = []
        deadline = time.monotonic() + seconds
        while len(found) < count and time.monotonic() < deadline:
            parts = self.receive(lambda m: isinstance(m, list), deadline - time.monotonic())
            if parts is None:
                break
            if parts[-1][0]["kind"] == CURSOR_PART:
                self.cursors.append(parts[-1])
                continue
            found.append(parts[-1])
            self.send({"ack": {"frame": parts[-1][0]["frame"], "shownMs": 1.0}})
        return found


def parts_of(message):
    parts = []
    while message:
        header = dict(zip(PART_NAMES, PART.unpack_from(message)))
        end = PART.size + header["bytes"]
        parts.append((header, message[PART.size:end]))
        message = message[end:]
    return parts
