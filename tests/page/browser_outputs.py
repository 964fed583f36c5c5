#!/usr/bin/env python3
"""What outputs show, proved by their hashes, and their pictures in a browser.

browser_outputs.py --build build/release [--cases proof] [--list]
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(TOP, "tests", "page"))
from page_session import SIZE, Page, draws, ended, session  # noqa: E402
from harness import cases, pictures  # noqa: E402
from harness.control import result_of  # noqa: E402
from page_client import H264_PART, JPEG_PART, KEY, PNG_PART, STILL, WebSocket, request  # noqa: E402

LIVE_SECONDS = 1.5
FROZEN_SECONDS = 3.0
MOST_ERROR = 1.3  # squared error of H.264 relative to JPEG of quality 80


def outputs(viewer, accept=lambda data: True, seconds=20):
    """Returns the first message of the topic that `accept` accepts, as {node: entry}."""
    message = viewer.receive(lambda m: isinstance(m, dict) and m.get("topic") == "outputs" and accept({e["node"]: e for e in m["data"]}), seconds)
    return message and {entry["node"]: entry for entry in message["data"]}


def output_ages(page):
    """Returns mural_output_age_seconds by node."""
    text = request(page.url, "/metrics", page.token)[2].decode()
    return {int(node): float(age) for node, age in re.findall(r'^mural_output_age_seconds{.*node="(\d+)"} (\S+)$', text, re.M)}


def proofs(context, display, options=()):
    """Hashes follow the pictures; a stopped node has none, and a program that rests keeps live outputs."""
    wrong = []
    with session(context, "2x1", display) as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run, *options) as page, WebSocket(page.url) as viewer:
            viewer.hello(page.token)
            viewer.ask("subscribe", {"topic": "outputs", "interval": 200})
            is_live = lambda data: len(data) == 2 and all(e["ageSeconds"] < LIVE_SECONDS for e in data.values())
            first = outputs(viewer, is_live)
            second = first and outputs(viewer, lambda data: is_live(data) and all(data[n]["frame"] > first[n]["frame"] for n in data))
            if second is None:
                return "no live outputs: %s" % first
            if any(second[n]["hash"] == first[n]["hash"] for n in first):
                wrong.append("the same hash of different frames: %s, %s" % (first, second))
            if any((entry["skewMs"] is None) != (display == "app") for entry in second.values()):
                wrong.append("skew: %s" % second)
            nodes = {node["node"]: node["pid"] for node in result_of(context, run, "status")["nodes"]}
            os.kill(nodes[1], signal.SIGSTOP)
            frozen = outputs(viewer, lambda data: data[1]["ageSeconds"] > FROZEN_SECONDS, 30)
            ages = output_ages(page)
            if not (ages.get(1, 0) > FROZEN_SECONDS and (display == "windows" or ages.get(0, FROZEN_SECONDS) < LIVE_SECONDS)):
                wrong.append("mural_output_age_seconds while node 1 is stopped: %s" % ages)
            os.kill(nodes[1], signal.SIGCONT)
            # Nodes with windows wait for each other at each swap.
            if frozen is None or (display == "app" and frozen[0]["ageSeconds"] > LIVE_SECONDS):
                wrong.append("node 1 is stopped, and node 0 is not: %s" % frozen)
            again = outputs(viewer, is_live)
            if again is None:
                wrong.append("no live outputs after the node goes on")
            programs = stopped(run, 1)
            rests = outputs(viewer, is_live)
            later = rests and outputs(viewer, lambda data: is_live(data))
            goes_on(programs)
            if later is None or any((later[n]["hash"], later[n]["frame"]) != (rests[n]["hash"], rests[n]["frame"]) for n in rests):
                wrong.append("the program rests: %s, %s" % (rests, later))
        return ended(context, run, wrong)


@cases.case
def proof_by_the_head(context):
    """The head has the pictures (--display app)."""
    return proofs(context, "app")


@cases.case
def proof_by_the_nodes(context):
    """The nodes have windows of their own (--display windows)."""
    return proofs(context, "windows")


def stopped(run, seconds=0.6):
    """Stops the program, and returns its processes. The wall then rests."""
    programs = run.processes(r"long_run|input_events")
    for pid in programs:
        os.kill(pid, signal.SIGSTOP)
    time.sleep(seconds)
    return programs


def goes_on(programs):
    for pid in programs:
        os.kill(pid, signal.SIGCONT)


def decoded(units, size, kind="h264"):
    """Returns the pictures, as rows of RGB, by ffmpeg."""
    command = ["ffmpeg", "-v", "error", "-f", kind, "-i", "-", "-f", "rawvideo", "-pix_fmt", "rgb24", "-vsync", "passthrough", "-"]
    done = subprocess.run(command, input=b"".join(units), stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60, check=False)
    bytes_each = size[0] * size[1] * 3
    return [done.stdout[at:at + bytes_each] for at in range(0, len(done.stdout), bytes_each)], done.stderr.decode().strip()


def mean_square(first, second):
    return sum((a - b) ** 2 for a, b in zip(first, second)) / len(first)


def pixels_of(png):
    with tempfile.NamedTemporaryFile(suffix=".png") as file:
        file.write(png)
        file.flush()
        return b"".join(pictures.read_png(file.name).rows)


@cases.case
def windows_of_nodes(context):
    """Pictures of the nodes' own windows, in each class; nodes send none unless somebody looks."""
    wrong = []
    with session(context, "2x1", "windows") as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page, WebSocket(page.url) as viewer:
            viewer.hello(page.token)
            for name, of, size in (("thumb", "wall", (320, 200)), ("full", "wall", (320, 200)), ("preview", 1, (160, 200))):
                reply = viewer.ask("preview", {"class": name, "of": of})
                found = viewer.pictures(3)
                frames = [header["frame"] for header, _ in found if not header["flags"] & STILL]
                if not reply["ok"] or len(found) < 3 or frames != sorted(set(frames)):
                    wrong.append("%s of %s: %s, frames %s" % (name, of, reply, frames))
                elif (found[-1][0]["pictureWidth"], found[-1][0]["pictureHeight"]) != size:
                    wrong.append("%s of %s: %s" % (name, of, found[-1][0]))
            viewer.ask("preview", {"class": "full"})
            programs = stopped(run, 1)
            viewer.pictures(4, 2)
            shown = pixels_of(request(page.url, "/api/v1/picture.png", page.token)[2])
            goes_on(programs)
            viewer.ask("preview", {"class": "off"})
            bright = sum(shown) / len(shown)
            halves = [sum(shown[at] for y in range(200) for at in range(960 * y + left, 960 * y + left + 480, 7)) for left in (0, 480)]
            if bright < 5 or min(halves) == 0:
                wrong.append("the picture is dark: mean %.1f, halves %s" % (bright, halves))
        return ended(context, run, wrong)


@cases.case
def video(context):
    """H.264 by one encoder: key frames on join and loss alone, decodable, then the exact still; JPEG for others."""
    wrong = []
    with session(context, "2x1") as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page, WebSocket(page.url) as first, WebSocket(page.url) as second, \
                WebSocket(page.url) as plain, WebSocket(page.url) as slow:
            for viewer, has_decoder in ((first, True), (second, True), (plain, False), (slow, True)):
                viewer.hello(page.token, h264=has_decoder)
            first.ask("preview", {"class": "full"})
            began = time.monotonic()
            units = first.pictures(12)
            slow.ask("preview", {"class": "full"})  # acknowledges nothing
            second.ask("preview", {"class": "full"})
            joined = second.pictures(3)
            plain.ask("preview", {"class": "full"})
            jpegs = plain.pictures(2)
            units += first.pictures(12)
            programs = stopped(run, 1.2)
            units += first.pictures(30, 3)
            seconds = time.monotonic() - began
            # A viewer whose link was never slow.
            with WebSocket(page.url) as late:
                late.hello(page.token, h264=True)
                late.ask("preview", {"class": "full"})
                resting = late.pictures(2, 5)
            exact = request(page.url, "/api/v1/picture.png", page.token)[2]
            jpeg = request(page.url, "/api/v1/picture.jpg?q=80", page.token)[2]
            goes_on(programs)
            stills = [payload for header, payload in resting if header["flags"] & STILL]
            units = [(header, payload) for header, payload in units if not header["flags"] & STILL]
            kinds = {header["kind"] for header, _ in units}
            keys = sum(header["flags"] & KEY for header, _ in units)
            if kinds != {H264_PART} or not units[0][0]["flags"] & KEY or not 1 <= keys <= seconds + 2:
                wrong.append("kinds %s, %d key frames in %.1f s" % (kinds, keys, seconds))
            if not joined or joined[0][0]["kind"] != H264_PART or not joined[0][0]["flags"] & KEY:
                wrong.append("the second viewer begins with %s" % (joined and joined[0][0]))
            if [header["kind"] for header, _ in jpegs if not header["flags"] & STILL][:1] != [JPEG_PART]:
                wrong.append("a viewer without a decoder: %s" % [header for header, _ in jpegs])
            if stills != [exact] or [header["kind"] for header, _ in resting] != [H264_PART, PNG_PART]:
                wrong.append("no exact still: %s" % [header for header, _ in resting])
            size = (units[-1][0]["pictureWidth"], units[-1][0]["pictureHeight"])
            shown, errors = decoded([payload for _, payload in units], size)
            if errors or len(shown) != len(units):
                wrong.append("ffmpeg decodes %d of %d units: %s" % (len(shown), len(units), errors[:200]))
            elif stills:
                pixels = pixels_of(exact)
                errors = [mean_square(picture, pixels) for picture in (shown[-1], decoded([jpeg], size, "mjpeg")[0][0])]
                print("    mean square errors of H.264 and JPEG: %.1f, %.1f" % tuple(errors))
                if errors[0] > MOST_ERROR * errors[1]:
                    wrong.append("mean square errors of H.264 and JPEG: %s" % errors)
            each = lambda kind, found: sum(len(p) for h, p in found if h["kind"] == kind) / max(1, sum(h["kind"] == kind for h, _ in found))
            print("    bytes per picture: H.264 %.0f, JPEG %.0f, still %d" % (each(H264_PART, units), each(JPEG_PART, jpegs), len(exact)))
        return ended(context, run, wrong)


@cases.case
def pointer(context):
    """The shape and the place of the program's pointer reach viewers, on private displays alone."""
    wrong = []
    command = [context.program("input_events"), "--frames", "1000000", "--size", SIZE]
    with context.run(command, ["--size", SIZE, "--tiles", "2x1", "--display", "app"]) as run:
        if draws(run) is not True:
            return draws(run)
        with Page(context, run) as page, WebSocket(page.url) as viewer:
            viewer.hello(page.token)
            viewer.ask("preview", {"class": "preview"})
            viewer.ask("input-take")
            deadline = time.monotonic() + 20
            shape = None
            places = set()
            number = 0
            while time.monotonic() < deadline and not (shape and (0.25, 0.75) in places):
                number += 1
                viewer.send({"input": {"seq": number, "kind": "move", "x": 0.25, "y": 0.75}})
                viewer.pictures(2, 1)
                for header, payload in viewer.cursors:
                    shape = payload or shape
                    places.add((round(header["x"] / 65535, 2), round(header["y"] / 65535, 2)))
                viewer.cursors.clear()
            if not (shape or b"").startswith(b"\x89PNG") or (0.25, 0.75) not in places:
                wrong.append("shape %s, places %s" % (shape and shape[:8], places))
        return ended(context, run, wrong)


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
