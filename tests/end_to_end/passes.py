#!/usr/bin/env python3
"""Frames drawn in several passes: eyes, samples, pixels of a kernel, phases. The reference is programs that do the work
of a pass natively; this script combines the pictures of passes again.

  passes.py --build build/release [--cases stereo,subpixel] [--list]
"""

import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time

from harness import cases, length, pictures
from harness.wall_pictures import FRAMES, SIZE, case, differing, first_wrong, in_session, native, of_programs, through, through_all

EYE, FOCUS = 0.3, 6.0


# ---- turns

@case
def dplex_pictures_are_all_there(context, notes):
    """Every frame arrives, in order, from programs that clear, that do not, and that copy their window."""
    names, frames = ("immediate", "es2_scene", "frames_kept", "core_arrays", "pixels_read"), 9
    plain = [native(context, name, frames=frames) for name in names]
    drawn = through_all(context, ["--dplex", "3"], of_programs(names), frames=frames, counts=list(map(len, plain)))
    return first_wrong({name: differing(*both) for name, *both in zip(names, plain, drawn)})


@case
def dplex_shares_the_work(context, notes):
    """All nodes draw a clearing program in turn, and no node more than its share."""
    frames = 30
    options = ["--display", "none", "--dplex", "3", "--explain"]
    with context.drawing("long_run", frames, options=options) as run:
        wrong = cases.check_end(run, 0, frames)
        printed = [line for line in run.standard_error if "one node draws all frames" in line]
    return wrong or (printed[0] if printed else None)


# ---- samples

def jitter(sample, samples):
    """Returns the sample's position in its pixel: in column i of n, and in the row of its place among the radical
    inverses."""
    def radical_inverse(i):
        return int(bin(i)[:1:-1], 2) / 2 ** (len(bin(i)) - 2)
    order = sorted(range(samples), key=radical_inverse)
    return (sample + 0.5) / samples - 0.5, (order.index(sample) + 0.5) / samples - 0.5


def largest_error(samples, got):
    """Returns the largest error of a picture against the unrounded mean of others."""
    largest, n = 0, len(samples)
    for y, row in enumerate(got.rows):
        sums = map(sum, zip(*(picture.rows[y] for picture in samples)))
        largest = max(largest, max(abs(n * value - total) for value, total in zip(row, sums)))
    return largest / n


def sampled(context, program, arguments, samples, size=SIZE):
    """Returns the largest error of Mural's pictures against the native mean."""
    moved = []
    for sample in range(samples):
        x, y = jitter(sample, samples)
        moved.append(native(context, program, list(arguments) + ["--move", "%.17g,%.17g" % (-x, -y)], size))
    got = through(context, ["--subpixel", str(samples)], program, arguments, size)
    if len(got) != len(moved[0]):
        raise AssertionError("%d pictures instead of %d" % (len(got), len(moved[0])))
    plain = native(context, program, arguments, size)
    if all(picture.rows == other.rows for picture, other in zip(got, plain)):
        raise AssertionError("nothing was sampled")
    return max(largest_error([frames[i] for frames in moved], picture) for i, picture in enumerate(got))


def sampled_ways(context, notes, scenes):
    wrong = None
    for program, arguments, samples, size in length.some(scenes):
        error = sampled(context, program, arguments, samples, size)
        name = "%s %d" % (" ".join(arguments[1:]) or program, samples)
        notes.append("%s: %.3f" % (name, error))
        if error > 1:
            wrong = wrong or "%s: largest error %.3f" % (name, error)
    return wrong


@case
def subpixel_is_the_mean(context, notes):
    return sampled_ways(context, notes, [
        ("pass_scene", ["--draw", "fixed"], 2, SIZE), ("pass_scene", ["--draw", "mvp"], 4, SIZE), ("pass_scene", ["--draw", "geometry"], 3, (160, 121)),
        ("pass_scene_es2", [], 2, SIZE), ("pass_scene_es2", [], 4, (250, 190))])


MVP = ("pass_scene", ("--draw", "mvp"))
COPIED = of_programs(("copied_scene", "pixels_read", "es2_scene", "copied_samples"))
# undivided, and divided by tiles
DIVIDED = {"samples": (["--subpixel", "2"], ["--subpixel", "2", "--tiles", "2x1", "--local-nodes", "4"]),
           "eyes": (["--stereo", "anaglyph"], ["--stereo", "anaglyph", "--tiles", "1x2", "--local-nodes", "4"])}


def undivided_and_divided(context, scene, way):
    """Compares a scene of a pass with the same scene drawn by tiles. Cases share both sessions."""
    scenes = [copied for copied, other in length.pairs(COPIED, DIVIDED) if other == way] + ([MVP] if way == "samples" else [])
    return differing(*(in_session(context, options, scene, scenes) for options in DIVIDED[way]))


@case
def passes_copy_their_own_pixels(context, notes):
    """Tiles of an eye or a sample that is copied: pixels from other nodes belong to another pass."""
    return first_wrong({"%s, %s" % (scene[0], way): undivided_and_divided(context, scene, way) for scene, way in length.pairs(COPIED, DIVIDED)})


# ---- pixels of a kernel

POLYGONS = length.some((("pass_scene", ("--draw", "mvp"), "2x1"), ("pass_scene", ("--draw", "fixed"), "3"), ("pass_scene_es2", (), "2x2"),
                        ("pass_scene", ("--draw", "mvp"), "2x2"), ("pass_scene", ("--draw", "geometry"), "3x2")))
# with the least PSNR
FRAGMENTS = (("frag_coord", "2x1", 50), ("frag_coord", "3x2", 50), ("fragment_places", "2x1", math.inf), ("fragment_places", "3x2", math.inf), ("textures_modern", "3x2", 60))
COPIES = [(*scene, kernel) for scene, kernel in length.pairs((("pixels_read", ()), ("es2_scene", ()), ("pass_scene", ("--draw", "blit"))), ("2x1", "3x2"))]
LEVELS = [(*scene, kernel) for scene, kernel in length.pairs((("pass_scene", ("--draw", "textured")), ("pass_scene_es2", ("--draw", "textured"))), ("2x1", "3x2"))]


def by_kernel(context, program, arguments, kernel):
    """Returns the pictures of a scene with a kernel. One session draws all scenes with that kernel."""
    scenes = POLYGONS + [(name, (), other) for name, other, _ in FRAGMENTS] + COPIES + LEVELS
    return in_session(context, ["--pixel", kernel], (program, arguments), [tuple(scene) for *scene, other in scenes if other == kernel])


@case
def pixel_polygons_are_near(context, notes):
    wrong = None
    for program, arguments, kernel in POLYGONS:
        plain = native(context, program, arguments)
        got = by_kernel(context, program, arguments, kernel)
        worst = min(pictures.decibels(a, b) for a, b in zip(plain, got))
        notes.append("%s %s: %.1f dB" % (arguments[-1] if arguments else program, kernel, worst))
        if len(got) != len(plain) or worst < 40:
            wrong = wrong or "%s: %d pictures, %.1f dB" % (kernel, len(got), worst)
        if all(a.rows == b.rows for a, b in zip(plain[1:], got[1:])):
            wrong = wrong or "%s: the kernel was not used" % kernel
    return wrong


@case
def pixel_fragments_have_wall_positions(context, notes):
    """Drawing that uses only gl_FragCoord equals the native one; derivatives and texture levels nearly. In assembly,
    too."""
    wrong = None
    for program, kernel, minimum in FRAGMENTS:
        plain, got = native(context, program), by_kernel(context, program, (), kernel)
        worst = min(pictures.decibels(a, b) for a, b in zip(plain, got))
        notes.append("%s %s: %.1f dB" % (program, kernel, worst))
        if len(got) != len(plain) or worst < minimum:
            wrong = wrong or "%s %s: %d pictures, %.1f dB" % (program, kernel, len(got), worst)
    return wrong


def exact_by_kernel(context, scenes):
    return first_wrong({"%s %s" % (program, kernel): differing(native(context, program, arguments), by_kernel(context, program, arguments, kernel))
                        for program, arguments, kernel in scenes})


@case
def pixel_is_exact_where_pixels_are_copied(context, notes):
    return exact_by_kernel(context, COPIES)


@case
def pixel_is_exact_with_explicit_levels(context, notes):
    """The fixed function and OpenGL ES select texture levels by the drawn pixels. Such programs draw all pixels, from
    the next frame on."""
    wrong = exact_by_kernel(context, LEVELS)
    levels, plain = (native(context, "pass_scene", ["--draw", way]) for way in ("textured", "fixed"))
    return wrong or (None if differing(levels, plain) else "no level was looked up")


# ---- eyes

def overlay(picture):
    """Returns the quarter of the picture without perspective, which is equal for all eyes."""
    return [row[:3 * (picture.width // 2 - 1)] for row in picture.rows[(picture.height + 1) // 2 + 1:]]


BASE = ["--eye-base", str(2 * EYE), "--focus", str(FOCUS)]
FIXED_AND_ES = [("pass_scene", ("--draw", way)) for way in ("fixed", "legacy")] + [("pass_scene_es2", ())]
BY_SHADERS = [("pass_scene", ("--draw", way)) for way in ("matrices", "mvp", "block", "geometry", "tessellation")]
ELSEWHERE = [("pass_scene", ("--draw", way)) for way in ("framebuffer", "blit")]


def of_eye(context, program, arguments, mode):
    """Returns the pictures of a scene for the left or the right eye. One session draws all scenes for that eye."""
    seen_by = [MVP]
    for scenes in (FIXED_AND_ES, BY_SHADERS, ELSEWHERE):
        seen_by += [scene for scene, eye in length.pairs(scenes, (-EYE, EYE)) if mode == ("left" if eye < 0 else "right") and scene not in seen_by]
    return in_session(context, ["--stereo", mode] + BASE, (program, arguments), seen_by)


def seen(context, program, arguments, eye):
    """Returns the distance of Mural's picture for an eye from the native one, and whether its overlay is unchanged."""
    got = of_eye(context, program, arguments, "left" if eye < 0 else "right")
    wanted = native(context, program, list(arguments) + ["--eye", "%g,%g" % (eye, FOCUS)])
    plain = native(context, program, arguments)
    if len(got) != len(wanted):
        raise AssertionError("%d pictures instead of %d" % (len(got), len(wanted)))
    worst = min(pictures.decibels(a, b) for a, b in zip(wanted, got))
    kept = all(overlay(a) == overlay(b) for a, b in zip(plain, got))
    return worst, kept, min(pictures.decibels(a, b) for a, b in zip(plain, wanted))


def seen_ways(context, notes, scenes):
    wrong = None
    for (program, arguments), eye in length.pairs(scenes, (-EYE, EYE)):
        name = arguments[-1] if arguments else program
        worst, kept, apart = seen(context, program, arguments, eye)
        notes.append("%s %s: %.1f dB (%.1f from the middle)" % (name, "left" if eye < 0 else "right", worst, apart))
        if worst < 40 or not kept:
            wrong = wrong or "%s: %.1f dB%s" % (name, worst, "" if kept else ", the overlay has moved")
    return wrong


@case
def stereo_eyes_fixed_and_es(context, notes):
    return seen_ways(context, notes, FIXED_AND_ES)


@case
def scenes_drawn_elsewhere(context, notes):
    """A scene in a framebuffer object that is then shown: the scene moves, but not the quad or blit, nor its shadow
    map."""
    return seen_ways(context, notes, ELSEWHERE) or sampled_ways(context, notes, [scene + (2, SIZE) for scene in ELSEWHERE])


@case
def stereo_eyes_by_shaders(context, notes):
    return seen_ways(context, notes, BY_SHADERS)


def anaglyph(left, right):
    rows = []
    for a, b in zip(left.rows, right.rows):
        row = bytearray(b)
        row[0::3] = a[0::3]
        rows.append(bytes(row))
    return pictures.Picture(left.width, left.height, rows)


def side_by_side(left, right):
    half = (left.width + 1) // 2
    return pictures.Picture(left.width, left.height, [pictures.halved(a, half) + pictures.halved(b, left.width - half) for a, b in zip(left.rows, right.rows)])


@case
def stereo_pictures_are_put_together(context, notes):
    left, right = (of_eye(context, *MVP, mode) for mode in ("left", "right"))
    show = lambda mode, *more: through(context, ["--stereo", mode] + BASE + list(more), *MVP)
    turned = show("anaglyph", "--dplex", "2")
    both = [anaglyph(a, b) for a, b in zip(left, right)]
    return first_wrong({"anaglyph": differing(both, show("anaglyph")), "with dplex": differing(both, turned),
                        "side by side": differing([side_by_side(a, b) for a, b in zip(left, right)], show("side-by-side"))})


# ---- screens of a room

ROOM = """#Equalizer 1.2 ascii
server { config {
    node { pipe { window { viewport [ 0 0 %(w)d %(h)d ] channel { name "left" } } } }
    node { pipe { window { viewport [ 0 0 %(w)d %(h)d ] channel { name "front" } } } }
    node { pipe { window { viewport [ 0 0 %(w)d %(h)d ] channel { name "right" } } } }
    observer { eye_cyclop [ .2 -.1 .3 ] }
    layout { view { observer 0 } }
    canvas { layout 0
        segment { channel "left" viewport [ 0 0 .333333333333333333 1 ]
            wall { bottom_left [ -1 -.75 1 ] bottom_right [ -1 -.75 -1 ] top_left [ -1 .75 1 ] } }
        segment { channel "front" viewport [ .333333333333333333 0 .333333333333333333 1 ]
            wall { bottom_left [ -1 -.75 -1 ] bottom_right [ 1 -.75 -1 ] top_left [ -1 .75 -1 ] } }
        segment { channel "right" viewport [ .666666666666666667 0 .333333333333333333 1 ]
            wall { bottom_left [ 1 -.75 -1 ] bottom_right [ 1 -.75 1 ] top_left [ 1 .75 -1 ] } } }
    %(compounds)s } }
"""
# The front wall drawn by two nodes.
SHARED_WALL = """
    node { pipe { window { viewport [ 0 0 %(w)d %(h)d ] channel { name "helper" } } } }
    compound {
        compound { channel "left" }
        compound { channel "right" }
        compound { channel "front"
            compound { viewport [ 0 0 .4 1 ] }
            compound { channel "helper" viewport [ .4 0 .6 1 ] outputframe { name "rest" } }
            inputframe { name "rest" } } }
"""
# The walls as seen from the eye in ROOM: distance, left and right edge, degrees to the left.
WALLS = ((1.2, -0.7, 1.3, 90), (1.3, -1.2, 0.8, 0), (0.8, -1.3, 0.7, -90))


def in_room(context, scenes, size, compounds=""):
    """Returns the pictures of each scene; one session draws all of them."""
    words = {"w": size[0], "h": size[1]}
    with tempfile.TemporaryDirectory(prefix="mural-room.") as folder:
        path = os.path.join(folder, "room.eqc")
        with open(path, "w", encoding="ascii") as file:
            file.write(ROOM % dict(words, compounds=compounds % words))
        return through_all(context, ["--config", path], scenes, (3 * size[0], size[1]))


def room_ways(context, notes, scenes, size=(160, 120)):
    """Compares every wall of a room with a native picture with that wall's frustum."""
    wrong = None
    scenes = [(program, list(arguments) + ["--around"]) for program, arguments in length.some(scenes)]
    for (program, arguments), got in zip(scenes, in_room(context, scenes, size)):
        worst, apart = math.inf, math.inf
        # This scene draws the light's view over its upper right corner.
        has_shadow = "framebuffer" in arguments
        columns = size[0] * 3 // 4 if has_shadow else size[0]
        for wall, (distance, left, right, degrees) in enumerate(WALLS[:2] if has_shadow else WALLS):
            edges = (left / distance, right / distance, -0.65 / distance, 0.85 / distance, degrees, 0.2, -0.1, 0.3)
            wanted = native(context, program, arguments + ["--screen", ",".join("%.9g" % edge for edge in edges)], size)
            for number, (a, b) in enumerate(zip(wanted, got)):
                # The overlay covers the lower left quarter of the whole wall.
                upper = slice(0, size[1] // 2)
                start = 3 * wall * size[0]
                part = pictures.Picture(columns, size[1] // 2, [row[start:start + 3 * columns] for row in b.rows[upper]])
                want = pictures.Picture(columns, size[1] // 2, [row[:3 * columns] for row in a.rows[upper]])
                worst = min(worst, pictures.decibels(want, part))
                if len(set(want.rows)) < 10 and number == 0:
                    wrong = wrong or "wall %d shows next to nothing" % wall
            apart = min(apart, len(wanted) - len(got))
        notes.append("%s: %.1f dB" % (arguments[1] if len(arguments) > 1 else program, worst))
        if worst < 40 or apart != 0:
            wrong = wrong or "%s: %.1f dB" % (arguments[1], worst)
    return wrong


@case
def room_screens(context, notes):
    """Walls at right angles, seen off-centre: each as a program with that wall's frustum draws it."""
    return room_ways(context, notes, [("pass_scene", ["--draw", way]) for way in ("fixed", "legacy", "mvp", "matrices", "framebuffer", "block", "geometry")] + [("pass_scene_es2", [])])


def shown_and_saved(context, command, options, titles, out, frames=400):
    """Returns the contents of the wall windows with these titles, and all pictures of --out of the same run; or an
    error."""
    if shutil.which("xwd") is None:
        raise SystemExit("xwd is not installed: apt-get install x11-apps")
    with context.run(command, options + ["--display", "windows", "--out", out, "--frames", str(frames)]) as run:
        shown = window_pixels(context, titles, 30)
        status = run.status()
    if shown is None:
        return None, None, "no windows of the wall were seen"
    if status != 0:
        return None, None, "status %s" % status
    return shown, [pictures.read_png(os.path.join(out, name)) for name in sorted(os.listdir(out))], None


@case
def room_walls_have_windows(context, notes):
    """--display windows: the node of each wall shows it in its own window; the windows are side by side."""
    size, names = (160, 120), ("left", "front", "right")
    with tempfile.TemporaryDirectory(prefix="mural-room.") as folder:
        path, out = os.path.join(folder, "room.eqc"), os.path.join(folder, "out")
        with open(path, "w", encoding="ascii") as file:
            file.write(ROOM % {"w": size[0], "h": size[1], "compounds": ""})
        command = [context.program("pass_scene"), "--size", "%dx%d" % (3 * size[0], size[1]), "--frames", "100000", "--draw", "mvp", "--around"]
        shown, saved, wrong = shown_and_saved(context, command, ["--config", path, "--all-local"], ["Mural " + name for name in names], out)
    if wrong:
        return wrong
    walls = [[[row[3 * i * size[0]:3 * (i + 1) * size[0]] for row in p.rows] for p in saved] for i in range(3)]
    missing = [names[i] for i in range(3) if shown[i] not in walls[i]]
    return "windows %s show no part of any saved picture" % missing if missing else None


@case
def room_walls_are_shared(context, notes):
    """A wall that two nodes draw has no seam."""
    scenes, size = [("pass_scene", ["--draw", "mvp", "--around"])], (160, 120)
    return differing(in_room(context, scenes, size)[0], in_room(context, scenes, size, SHARED_WALL)[0])


# ---- several at once

@case
def subpixel_with_tiles(context, notes):
    return undivided_and_divided(context, MVP, "samples")


def window_pixels(context, titles, seconds):
    """Returns the rows of the windows with these titles when all show a picture; None after a timeout."""
    environment = dict(os.environ, DISPLAY=context.display)
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        dumps = [subprocess.run(["xwd", "-silent", "-name", title], env=environment, capture_output=True, check=False).stdout for title in titles]
        shown = [xwd_rows(dump) for dump in dumps if dump]
        if len(shown) == len(titles) and all(any(any(row) for row in rows) for rows in shown):
            return shown
        time.sleep(0.1)
    return None


def xwd_rows(dump):
    """Returns the RGB rows of a window dump with 32 bits per pixel."""
    header = struct.unpack(">25I", dump[:100])
    size, width, height, little, step, colours = header[0], header[4], header[5], header[7] == 0, header[12], header[19]
    start = size + 12 * colours
    order = (2, 1, 0) if little else (1, 2, 3)
    rows = []
    for y in range(height):
        row = dump[start + y * step:start + y * step + 4 * width]
        out = bytearray(3 * width)
        for k in range(3):
            out[k::3] = row[order[k]::4]
        rows.append(bytes(out))
    return rows


@case
def wall_windows_show_all_passes(context, notes):
    """--display windows: each tile's window shows its part of the picture of --out."""
    with tempfile.TemporaryDirectory(prefix="mural-passes.") as out:
        options = ["--tiles", "2x1", "--local-nodes", "4", "--subpixel", "2", "--position", "40,30"]
        size, frames = (252, 190), 100000
        command = [context.program("pass_scene"), "--size", "%dx%d" % size, "--frames", str(frames), "--draw", "mvp"]
        shown, saved, wrong = shown_and_saved(context, command, options, ["Mural tile 0", "Mural tile 1"], out)
    if wrong:
        return wrong
    half = 3 * (size[0] // 2)
    tiles = [[[row[:half] for row in p.rows] for p in saved], [[row[half:] for row in p.rows] for p in saved]]
    missing = [i for i in range(2) if shown[i] not in tiles[i]]
    return "windows %s show no part of any saved picture" % missing if missing else None


@case
def node_of_a_pass_is_killed(context, notes):
    """One line reports the loss, all frames arrive, the other passes continue."""
    frames = 60
    with tempfile.TemporaryDirectory(prefix="mural-passes.") as out:
        with context.drawing("long_run", frames, options=["--display", "none", "--subpixel", "3", "--out", out]) as run:
            if not run.wait_for_line("frame 20"):
                return "the program did not start: " + " | ".join(run.standard_error[-3:])
            cases.kill_all(run.wait_for_processes(cases.NODE, 3)[:1])
            wrong = cases.check_end(run, 0, frames)
            printed = cases.error_lines(run, ["was lost:"])
        saved = len(os.listdir(out))
    if wrong is None and (len(printed) != 1 or saved != frames):
        wrong = "%d lines about it, %d pictures instead of %d" % (len(printed), saved, frames)
    return wrong


if __name__ == "__main__":
    sys.exit(cases.main(__doc__))
