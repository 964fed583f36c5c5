#!/usr/bin/env python3
"""`mural page` with a real session: access, roles, pictures, documents, and the end of each process.

browser_page.py --build build/release [--cases roles] [--list]
"""

import json
import os
import random
import signal
import socket
import subprocess
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "page"))
from page_session import SIZE, Page, draws, ended, session  # noqa: E402
from harness import cases  # noqa: E402
from harness.control import result_of  # noqa: E402
from page_client import WebSocket, request  # noqa: E402
from page_schema import message_errors, metrics_errors  # noqa: E402

JPEG = b"\xff\xd8\xff"
PNG = b"\x89PNG"
DENIED = 4401
TOO_MANY = 4429
SESSION_ENDED = 4410


@cases.case
def access(context):
    """No, wrong, expired, revoked and too many tokens; foreign hosts and origins (A-9)."""
    wrong = []
    with session(context) as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page:
            expect = lambda what, got, want: wrong.append("%s: %s instead of %s" % (what, got, want)) if got != want else None
            expect("no token", request(page.url, "/api/v1/state")[0], 401)
            expect("wrong token", request(page.url, "/api/v1/state", "x" * 43)[0], 401)
            expect("right token", request(page.url, "/api/v1/state", page.token)[0], 200)
            expect("token in the address", request(page.url, "/api/v1/state?token=" + page.token)[0], 401)
            expect("foreign host", request(page.url, "/", headers={"Host": "evil.example"})[0], 421)
            expect("foreign origin", request(page.url, "/api/v1/state", page.token, headers={"Origin": "http://evil.example"})[0], 403)
            with WebSocket(page.url, origin="http://evil.example") as foreign:
                expect("WebSocket of a foreign origin", foreign.status, 403)
            with WebSocket(page.url, protocol=None) as other:
                expect("WebSocket without a subprotocol", other.status, 400)
            with WebSocket(page.url) as silent:
                silent.send({"id": 1, "op": "status"})
                expect("request before the hello", silent.close_code(), DENIED)
            with WebSocket(page.url) as binary:
                binary.hello(page.token)
                binary.frame(2, b"\x00")
                expect("binary message", binary.close_code(), 1003)
            number, token = page.link("view", most=1)
            with WebSocket(page.url) as viewer, WebSocket(page.url) as second:
                expect("role of the link", (viewer.hello(token) or {}).get("role"), "view")
                second.send({"hello": {"token": token}})
                expect("second page of a link for one", second.close_code(), TOO_MANY)
                began = time.monotonic()
                expect("revoke", page.command("revoke", str(number))[0], 0)
                began = min(began + 30, time.monotonic())
                expect("revoked page", viewer.close_code(5), DENIED)
                if time.monotonic() - began > 1:
                    wrong.append("a revoked page closed after %.1f s" % (time.monotonic() - began))
            _, short = page.link("view", seconds=1)
            with WebSocket(page.url) as viewer:
                viewer.hello(short)
                expect("expired page", viewer.close_code(5), DENIED)
            expect("expired token", request(page.url, "/api/v1/state", short)[0], 401)
            codes = [request(page.url, "/api/v1/state", "guess%d" % i)[0] for i in range(12)]
            expect("last of twelve guesses", codes[-1], 429)
            expect("a right token from that address", request(page.url, "/api/v1/state", page.token)[0], 429)
        return ended(context, run, wrong)


@cases.case
def roles(context):
    """Every operation with each role; random messages with a view token reach nothing (A-8)."""
    wrong = []
    with session(context) as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page:
            with WebSocket(page.url) as owner:
                owner.hello(page.token)
                operations = [operation["name"] for operation in owner.ask("help")["result"]["operations"]]
                before = owner.ask("latency")["result"]
            reading = {"help", "status", "nodes", "report", "frames", "equalizers", "unsubscribe", "subscribe", "preview", "wall", "outputs",
                       "latency", "overlay", "layout", "plan", "log-level"}
            lease = {"input-take", "input-release"}
            for role in ("view", "input"):
                _, token = page.link(role)
                for operation in operations:
                    code, _, body = request(page.url, "/api/v1/ops", token, "POST", {"op": operation, "args": {}})
                    is_denied = json.loads(body).get("code") == "denied" and code == 403
                    if is_denied == (operation in reading or (role == "input" and operation in lease)):
                        wrong.append("%s with the role %s: %d %s" % (operation, role, code, body[:100]))
            code, _, body = request(page.url, "/api/v1/ops", token, "POST", {"op": "latency", "args": {"frames": 9}})
            if json.loads(body).get("code") != "denied":
                wrong.append("latency 9 with the role input: %s" % body)
            _, token = page.link("view")
            chance = random.Random(4711)
            words = operations + ["hello", "input", "ack", "ping", "args", "stop", "", "\u00e4", "seq", "kind", "frames"]
            with WebSocket(page.url) as viewer:
                viewer.hello(token)
                for i in range(10000):
                    if viewer.closed:
                        wrong.append("the page closed after %d messages: %s" % (i, viewer.closed))
                        break
                    viewer.send(chance.choice([
                        lambda: {"id": i, "op": chance.choice(words), "args": {chance.choice(words): chance.randint(-5, 5)}},
                        lambda: {"input": {"seq": i, "kind": chance.choice(["down", "key", "text", "move"]), "x": chance.random(), "y": 0.5, "key": "q", "down": True}},
                        lambda: {chance.choice(words): chance.choice([None, [], {}, 1, "x", {"frame": -1}])},
                        lambda: "".join(chance.choice('{}[]",:0aé') for _ in range(chance.randint(0, 60)))])())
                    if i % 100 == 0:
                        viewer.receive(lambda _: False, 0.001)
                viewer.send({"ping": 1})
                if viewer.receive(lambda m: isinstance(m, dict) and "pong" in m, 30) is None and not wrong:
                    wrong.append("no pong after the random messages: %s" % (viewer.closed,))
            after = result_of(context, run, "latency")
            if after != before:
                wrong.append("the latency changed from %s to %s" % (before, after))
        return ended(context, run, wrong)


@cases.case
def operations(context):
    """Requests, topics and the wall through the WebSocket."""
    wrong = []
    with session(context, "2x2") as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page, WebSocket(page.url) as viewer:
            welcome = viewer.hello(page.token)
            if welcome["role"] != "operate" or "headPid" not in welcome["session"]:
                wrong.append("welcome: %s" % welcome)
            clients = viewer.receive(lambda m: m.get("topic") == "clients")
            if not clients or clients["data"][0]["client"] != welcome["client"]:
                wrong.append("clients: %s" % clients)
            if viewer.ask("subscribe", {"topic": "status", "interval": 100})["ok"] is not True:
                wrong.append("no subscription")
            frames = [viewer.receive(lambda m: m.get("topic") == "status")["data"]["frames"] for _ in range(3)]
            if frames != sorted(frames) or frames[-1] <= 0:
                wrong.append("frames of the topic status: %s" % frames)
            viewer.ask("subscribe", {"topic": "timeline"}, 2)
            timeline = viewer.receive(lambda m: m.get("topic") == "timeline" and m["data"]["frames"], 30)
            if timeline is None:
                wrong.append("no frames of the timeline")
            wall = viewer.ask("wall", number=3)["result"]["canvases"][0]
            nodes = sorted(segment["node"] for segment in wall["segments"])
            rights = {segment["rectPx"][0] + segment["rectPx"][2] for segment in wall["segments"]}
            if nodes != [0, 1, 2, 3] or max(rights) != wall["sizePx"][0]:
                wrong.append("wall: %s" % wall)
            reply = viewer.ask("latency", {"frames": 3}, 4)
            if reply["result"] != {"latency": 3} or result_of(context, run, "latency") != {"latency": 3}:
                wrong.append("latency: %s" % reply)
            error = viewer.ask("no-such-operation", number=5)
            if error["ok"] or error["code"] != "unknown-operation":
                wrong.append("unknown operation: %s" % error)
            code = viewer.ask("restart-node", {"node": 1}, 6)
            if not code["ok"]:
                wrong.append("restart: %s" % code)
            for topic in ("events", "log", "outputs"):
                viewer.ask("subscribe", {"topic": topic, "interval": 100}, 7)
                if viewer.receive(lambda m: m.get("topic") == topic, 15) is None:
                    wrong.append("no message of the topic %s" % topic)
            viewer.send({"ping": 1.5})
            viewer.receive(lambda m: "pong" in m)
            viewer.send({"input": {"seq": 1, "kind": "move", "x": 0.5, "y": 0.5}})
            viewer.ask("links", number=8)
            wrong += message_errors(viewer.heard, viewer.said)
            wrong += metrics_errors(request(page.url, "/metrics", page.token)[2].decode())
        return ended(context, run, wrong)


@cases.case
def live_pictures(context):
    """Pictures of the wall and of a node in each class; their sizes; a still after the last frame."""
    wrong = []
    with session(context) as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page, WebSocket(page.url) as viewer:
            viewer.hello(page.token)
            for name, of, size, stream in (("thumb", "wall", (320, 200), 0), ("preview", "wall", (320, 200), 0),
                                           ("full", "wall", (320, 200), 0), ("preview", 1, (160, 200), 2)):
                reply = viewer.ask("preview", {"class": name, "of": of})
                found = viewer.pictures(3)
                # A still repeats the frame before it, when the wall rests on a busy machine.
                frames = [header["frame"] for header, _ in found if not header["flags"] & 4]
                if not reply["ok"] or len(found) < 3 or frames != sorted(set(frames)):
                    wrong.append("%s of %s: %s, frames %s" % (name, of, reply, frames))
                    continue
                header, payload = found[-1]
                if (header["pictureWidth"], header["pictureHeight"]) != size or header["stream"] != stream or not payload.startswith(PNG if header["flags"] & 4 else JPEG):
                    wrong.append("%s of %s: %s" % (name, of, header))
            nodes = [pid for pid in run.processes(cases.NODE)]
            for pid in nodes:
                os.kill(pid, signal.SIGSTOP)
            still = None
            deadline = time.monotonic() + 10
            while still is None and time.monotonic() < deadline:
                found = viewer.pictures(1, 5)
                still = found[0] if found and found[0][0]["flags"] & 4 else None
            for pid in nodes:
                os.kill(pid, signal.SIGCONT)
            if still is None:
                wrong.append("no still of a picture that rests")
            viewer.ask("preview", {"class": "off"})
            viewer.receive(lambda _: False, 0.5)
            if viewer.pictures(1, 1):
                wrong.append("pictures after preview off")
            status, headers, body = request(page.url, "/api/v1/picture.jpg?w=100&q=60", page.token)
            if status != 200 or not body.startswith(JPEG):
                wrong.append("picture.jpg: %d" % status)
            status, headers, body = request(page.url, "/api/v1/picture.png", page.token)
            if status != 200 or not body.startswith(b"\x89PNG") or headers["Content-Type"] != "image/png":
                wrong.append("picture.png: %d" % status)
        return ended(context, run, wrong)


DIALOG = (150, 100, 120, 60)  # of dialog_window: x, y, width, height
DIALOG_COLOUR = (0x33, 0x66, 0xcc)


def colour_at(jpeg, x, y):
    """Returns the colour of a pixel of a JPEG or PNG."""
    done = subprocess.run(["ffmpeg", "-v", "error", "-i", "-", "-vf", "format=rgb24,crop=1:1:%d:%d" % (x, y), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                          input=jpeg, stdout=subprocess.PIPE, timeout=30, check=True)
    return tuple(done.stdout[:3])


def is_near(colour, wanted):
    return len(colour) == 3 and all(abs(a - b) <= 8 for a, b in zip(colour, wanted))


@cases.case
def desktop_of_the_program(context):
    """The private display with a dialog that OpenGL does not draw, and a click into it. Without a private display: one
    line."""
    wrong = []
    command = [context.program("dialog_window"), "--frames", "1000000", "--size", SIZE]
    x, y = DIALOG[0] + 20, DIALOG[1] + 10
    with context.run(command, ["--size", SIZE, "--tiles", "2x1", "--display", "app"]) as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page, WebSocket(page.url) as viewer:
            viewer.hello(page.token)
            reply = viewer.ask("preview", {"class": "full", "of": "desktop"})
            found = viewer.pictures(3)
            if not reply["ok"] or len(found) < 3:
                return "no pictures of the display: %s" % reply
            header, payload = found[-1]
            if (header["pictureWidth"], header["pictureHeight"], header["stream"]) != (320, 200, 0xffffffff):
                wrong.append("a picture has the header %s" % header)
            if not is_near(colour_at(payload, x, y), DIALOG_COLOUR):
                wrong.append("the dialog has the colour %s" % (colour_at(payload, x, y),))
            if is_near(colour_at(payload, 10, 10), DIALOG_COLOUR) or colour_at(payload, 10, 10)[1] < 100:
                wrong.append("the program's window has the colour %s" % (colour_at(payload, 10, 10),))
            viewer.ask("input-take")
            time.sleep(1)  # the display is found with the first request
            for kind in ("down", "up"):
                viewer.send({"input": {"seq": 1, "kind": kind, "of": "desktop", "x": (x + 0.5) / 320, "y": (y + 0.5) / 200}})
            if not run.wait_for_line("dialog button 1 down 20,10", 5):
                wrong.append("the dialog did not get the click: %s" % [line for line in run.standard_output if "dialog" in line])
        wrong = ended(context, run, wrong)
    if wrong:
        return wrong
    with session(context) as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page, WebSocket(page.url) as viewer:
            viewer.hello(page.token)
            time.sleep(1)  # the page finds the display
            reply = viewer.ask("preview", {"class": "full", "of": "desktop"})
            if reply["ok"] or "display of its user" not in reply["error"] or viewer.pictures(1, 1):
                return "the display of the user is shown: %s" % reply
        return ended(context, run, [])


@cases.case
def one_encoding_for_all(context):
    """Many viewers of one class share its encodings, and one that never acknowledges slows nobody."""
    wrong = []
    with session(context) as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page:
            viewers = [WebSocket(page.url) for _ in range(8)]
            for viewer in viewers:
                viewer.hello(page.token)
                viewer.ask("preview", {"class": "preview"})
            counts = [len(viewers[0].pictures(20, 10))]  # all others acknowledge nothing
            counts += [len(viewer.pictures(3, 5)) for viewer in viewers[1:]]
            text = request(page.url, "/metrics", page.token)[2].decode()
            numbers = {line.split(" ")[0].split("{")[0]: float(line.rsplit(" ", 1)[1]) for line in text.splitlines() if 'class="preview"' in line}
            print("    pictures by viewer %s; %s" % (counts, numbers))
            if counts[0] < 20 or min(counts[1:]) < 2:
                wrong.append("pictures by viewer: %s" % counts)
            if numbers["mural_page_encodes_total"] > 0.75 * numbers["mural_page_pictures_total"]:
                wrong.append("encodings are not shared: %s" % numbers)
            for viewer in viewers:
                viewer.socket.close()
        return ended(context, run, wrong)


@cases.case
def documents(context):
    """Health, metrics (A-13), state against its schema, trace, configuration, and the headers of every response."""
    wrong = []
    with session(context) as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page:
            for path in ("/healthz", "/readyz"):
                status, _, body = request(page.url, path)
                if status != 200 or json.loads(body)["status"] != "pass":
                    wrong.append("%s: %d %s" % (path, status, body))
            status, headers, body = request(page.url, "/")
            policy = headers.get("Content-Security-Policy", "")
            if status != 200 or b"<html" not in body.lower() and headers.get("Content-Encoding") != "gzip" or "default-src 'self'" not in policy or headers.get("Cache-Control") != "no-store" or "frame-ancestors 'none'" not in policy:
                wrong.append("/: %d %s" % (status, headers))
            metrics = [request(page.url, "/metrics", page.token)[2].decode() for _ in range(2)]
            wrong += faults_of_metrics(*metrics)
            if request(page.url, "/metrics")[0] != 401:
                wrong.append("/metrics without a token")
            state = json.loads(request(page.url, "/api/v1/state", page.token)[2])
            schema = json.loads(request(page.url, "/api/v1/schema", page.token)[2])
            if state["tiles"] != "2x1" and state["tiles"] != [2, 1] or "$schema" not in schema:
                wrong.append("state: %s" % str(state)[:200])
            trace = json.loads(request(page.url, "/api/v1/trace.json?frames=20", page.token)[2])
            if not trace["traceEvents"]:
                wrong.append("the trace is empty")
            for path, begin in (("/api/v1/config.eqc", b"#Equalizer"), ("/api/v1/config.svg", b"<svg")):
                status, _, body = request(page.url, path, page.token)
                if status != 200 or begin not in body[:400]:
                    wrong.append("%s: %d %s" % (path, status, body[:100]))
            _, view = page.link("view")
            for path in ("/api/v1/config.eqc", "/api/v1/nodes/0/log", "/api/v1/links"):
                if request(page.url, path, view)[0] != 403:
                    wrong.append("%s with a view token: %d" % (path, request(page.url, path, view)[0]))
            for path, want in (("/api/v1/trace.json?frames=0", 400), ("/api/v1/picture.jpg?q=999", 400), ("/no", 404), ("/../etc/passwd", 404), ("/api/v1/no", 404)):
                if request(page.url, path, page.token)[0] != want:
                    wrong.append("%s: %d" % (path, request(page.url, path, page.token)[0]))
            wrong += malformed(page)
        return ended(context, run, wrong)


def faults_of_metrics(first, second):
    """Checks the form of both texts, and that no counter decreases."""
    values, kinds, wrong = [], {}, []
    for text in (first, second):
        found = {}
        for line in text.splitlines():
            if line.startswith("# TYPE "):
                kinds[line.split()[2]] = line.split()[3]
            elif not line.startswith("#"):
                name, _, value = line.rpartition(" ")
                if name in found or name.split("{")[0] not in kinds:
                    wrong.append("metric %s appears twice, or has no type" % name)
                found[name] = float(value)
        values.append(found)
    for name, value in values[0].items():
        if kinds[name.split("{")[0]] == "counter" and values[1].get(name, 0) < value:
            wrong.append("the counter %s decreased" % name)
    if not any(name.startswith("mural_frames_total") for name in values[0]):
        wrong.append("no metric mural_frames_total")
    return wrong


def malformed(page):
    """Sends invalid and oversized requests. Returns faults."""
    host, port = page.url.split("//")[1].strip("/").split(":")
    wrong = []
    for what, data, want in (("no HTTP", b"hello\r\n\r\n", b" 400 "),
                             ("large header", b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"x" * 9000 + b"\r\n\r\n", b" 431 "),
                             ("large body", b"POST /api/v1/ops HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2000000\r\n\r\n", b" 413 ")):
        with socket.create_connection((host, int(port)), 10) as connection:
            connection.sendall(data)
            first = connection.recv(100)
            if want not in first:
                wrong.append("%s: %s" % (what, first))
    return wrong


@cases.case
def addresses(context):
    """TLS beyond this machine (A-10), Unix sockets, ports in use, and a second page."""
    wrong = []
    with session(context) as run, tempfile.TemporaryDirectory() as state:
        if draws(run) is not True:
            return draws(run)
        run.environment["XDG_STATE_HOME"] = state
        pid = str(run.process.pid)
        refused = subprocess.run([context.mural, "page", pid, "--at", "0.0.0.0", "--page-tls", "off"], env=run.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=30, check=False)
        text = refused.stderr.decode()
        if refused.returncode != 2 or "ssh -L" not in text or "--page-insecure" not in text or text.count("\n") != 1:
            wrong.append("without TLS: %d %s" % (refused.returncode, text))
        with Page(context, run, "--at", "0.0.0.0") as page:
            port = page.url.rsplit(":", 1)[1].strip("/")
            local = "https://127.0.0.1:" + port + "/"
            if not page.url.startswith("https://") or request(local, "/api/v1/state", page.token)[0] != 200:
                wrong.append("TLS: %s" % page.url)
            with WebSocket(local) as viewer:
                if (viewer.hello(page.token) or {}).get("role") != "operate":
                    wrong.append("no WebSocket with TLS")
            second = subprocess.run([context.mural, "page", pid], env=run.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=30, check=False)
            if second.returncode != 2 or b"has a page already" not in second.stderr:
                wrong.append("second page: %d %s" % (second.returncode, second.stderr))
            taken = subprocess.run([context.mural, "page", pid, "--at", "127.0.0.1:" + port], env=run.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=30, check=False)
            if taken.returncode != 2 or taken.stderr.count(b"\n") != 1:
                wrong.append("port in use: %d %s" % (taken.returncode, taken.stderr))
            if page.command("--off")[0] != 0 or page.process.wait(10) != 0:
                wrong.append("--off")
        path = os.path.join(state, "page")
        with Page(context, run, "--at", "unix:" + path):
            with socket.socket(socket.AF_UNIX) as client:
                client.settimeout(10)
                client.connect(path)
                client.sendall(b"GET /healthz HTTP/1.1\r\nHost: any.example\r\nConnection: close\r\n\r\n")
                if b" 200 " not in client.recv(100):
                    wrong.append("no reply at a Unix socket")
            if os.stat(path).st_mode & 0o777 != 0o600:
                wrong.append("mode of the Unix socket: %o" % os.stat(path).st_mode)
        return ended(context, run, wrong)


class Hand:
    """Sends input as a viewer, and reads what the program prints."""

    def __init__(self, run, viewer):
        self.run, self.viewer, self.number, self.wrong = run, viewer, 0, []

    def send(self, kind, **members):
        self.number += 1
        self.viewer.send({"input": {"seq": self.number, "kind": kind, **members}})

    def expect(self, *lines):
        for line in lines:
            if not self.run.wait_for_line(line, 5):
                self.wrong.append("the program did not get: %s" % line)

    def tap(self, key, code, keysym):
        self.send("key", key=key, code=code, down=True)
        self.send("key", key=key, code=code, down=False)
        self.expect("key %s down" % keysym)


@cases.case
def input_of_viewers(context):
    """Pointer, wheel, keys and text reach the program at the right place; the lease; nothing stays down (A-6, A-7)."""
    wrong = []
    command = [context.program("input_events"), "--frames", "1000000", "--size", SIZE]
    with context.run(command, ["--size", SIZE, "--tiles", "2x1", "--display", "app"]) as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page:
            _, view = page.link("view")
            _, role = page.link("input")
            with WebSocket(page.url) as watcher, WebSocket(page.url) as viewer, WebSocket(page.url) as other:
                watcher.hello(view)
                viewer.hello(role, "first")
                other.hello(role, "second")
                reply = viewer.ask("input-take")
                time.sleep(1)  # the display is found with the first request
                hand = Hand(run, viewer)
                hand.send("blur")
                for x, y, place in ((0.25, 0.5, "80,100"), (0, 0, "0,0"), (1, 1, "319,199"), (0.999, 0.001, "319,0")):
                    hand.send("down", x=x, y=y)
                    hand.send("up", x=x, y=y)
                    hand.expect("button 1 down " + place, "button 1 up " + place)
                hand.send("wheel", dx=0, dy=-240)
                hand.expect("button 4 down", "button 4 down")
                hand.send("wheel", dx=120, dy=0)
                hand.expect("button 7 down")
                for key, code, keysym in (("a", "KeyA", "61"), ("A", "KeyA", "41"), ("?", "Slash", "3f"), ("Enter", "Enter", "ff0d"),
                                          ("\u00e4", "Quote", "e4"), ("\u20ac", "KeyE", "10020ac"), ("\u044f", "KeyZ", "100044f"), ("F5", "F5", "ffc2")):
                    hand.tap(key, code, keysym)
                hand.send("text", text="Hi!")
                hand.expect("key 48 down", "key 69 down", "key 21 down")
                watcher.send({"input": {"seq": 1, "kind": "key", "key": "w", "code": "KeyW", "down": True}})
                other.send({"input": {"seq": 1, "kind": "key", "key": "o", "code": "KeyO", "down": True}})
                hand.tap("x", "KeyX", "78")
                if any("key 77" in line or "key 6f" in line for line in run.standard_output):
                    wrong.append("input of viewers without the lease reached the program")
                hand.send("key", key="Shift", code="ShiftLeft", down=True)
                hand.send("key", key="Q", code="KeyQ", down=True)
                hand.send("down", x=0.5, y=0.5)
                hand.expect("key 51 down", "button 1 down")
                viewer.socket.close()
                for line in ("key ffe1 up", "button 1 up"):
                    if not run.wait_for_line(line, 3) and not any(line in printed for printed in run.standard_output[-12:]):
                        wrong.append("not released after the end of the viewer: %s" % line)
                held = [line for line in run.standard_output if line in ("key 51 up", "key 71 up")]
                if not held:
                    wrong.append("Q stays down")
                if not reply["ok"]:
                    wrong.append("input-take: %s" % reply)
                wrong += hand.wrong
        return ended(context, run, wrong)


@cases.case
def with_the_run(context):
    """`mural run --page` prints the address; the run goes on without its page, and the page ends with the run."""
    wrong = []
    command = [context.program("long_run"), "--frames", "1000000", "--size", SIZE]
    with context.run(command, ["--tiles", "2x1", "--display", "app", "--page"]) as run:
        if draws(run) is not True:
            return draws(run)
        address = next((line for line in run.standard_error if line.startswith("http://127.0.0.1:")), None)
        if address is None:
            return "no address: " + " | ".join(run.standard_error)
        url, _, token = address.strip().partition("#t=")
        with WebSocket(url) as viewer:
            if (viewer.hello(token) or {}).get("role") != "operate":
                wrong.append("the printed address does not open the page")
            page = result_of(context, run, "status") and run.processes(r"mural page\b")
            if len(page) != 1:
                return "processes of the page: %s" % page
            os.kill(page[0], signal.SIGKILL)
            if not run.wait_for_line("the page has ended (signal 9"):
                wrong.append("a killed page is not reported")
        frames = result_of(context, run, "status")["frames"]
        time.sleep(0.5)
        if result_of(context, run, "status")["frames"] <= frames:
            wrong.append("the wall stands still without its page")
        result = ended(context, run, wrong)
    port = socket.socket()
    port.bind(("127.0.0.1", 0))
    port.listen()
    taken = "127.0.0.1:%d" % port.getsockname()[1]
    with context.run(command, ["--tiles", "2x1", "--display", "app", "--page=" + taken]) as run:
        if not run.wait_for_line("the page has ended (exit status 2)"):
            wrong.append("a taken port is not reported: %s" % run.standard_error)
        if draws(run) is not True:
            return draws(run)
        result = ended(context, run, wrong)
    port.close()
    return result


@cases.case
def ends(context):
    """kill -9 of the page loses no frame (A-12); links and the audit trail remain; the page ends with a lost head."""
    wrong = []
    with session(context) as run:
        if draws(run) is not True:
            return draws(run)
        run.environment["MURAL_LOG_FORMAT"] = "json"
        with Page(context, run) as page, WebSocket(page.url) as viewer:
            viewer.hello(page.token)
            viewer.ask("preview", {"class": "full"})
            viewer.pictures(2)
            _, shared = page.link("view", name="class")
            revoked, ended_token = page.link("view")
            request(page.url, "/api/v1/links/%d" % revoked, page.token, "DELETE")
            page.process.kill()
            page.process.wait()
            lines = [json.loads(line) for line in page.process.stderr.read().decode().splitlines()]
            audit = [line["text"] for line in lines if " requests link-revoke " in line["text"] and line["topic"] == "session"]
            if not audit or not audit[-1].endswith('{"link":%d}: done' % revoked) or "127.0.0.1" not in audit[-1]:
                wrong.append("audit trail: %s" % [line["text"] for line in lines])
            if any(secret in line["text"] for line in lines for secret in (page.token, shared, ended_token)):
                wrong.append("a token is in the log")
        frames = [result_of(context, run, "status")["frames"]]
        time.sleep(0.5)
        state = result_of(context, run, "status")
        if state["frames"] <= frames[0] or any(node["state"] != "alive" for node in state["nodes"]):
            wrong.append("the session after kill -9 of its page: %s" % str(state)[:200])
        with Page(context, run) as page, WebSocket(page.url) as viewer:
            viewer.hello(page.token)
            viewer.ask("preview", {"class": "preview"})
            if not viewer.pictures(1):
                wrong.append("no pictures of a second page")
            with WebSocket(page.url) as other:
                if (other.hello(shared) or {}).get("role") != "view":
                    wrong.append("a link does not outlive its page")
            if request(page.url, "/api/v1/state", ended_token)[0] != 401:
                wrong.append("a revoked link lives again")
            os.kill(state["headPid"], signal.SIGKILL)
            event = viewer.receive(lambda m: isinstance(m, dict) and m.get("topic") == "events" and m["data"][0]["event"] == "session-ended", 3)
            if event is None or viewer.close_code(5) != SESSION_ENDED:
                wrong.append("the end of the head: %s, %s" % (event, viewer.closed))
            if page.process.wait(10) != 0:
                wrong.append("status of the page: %s" % page.process.returncode)
        return "; ".join(wrong) or None


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
