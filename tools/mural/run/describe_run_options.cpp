// The options of `mural run` as its help lists them.
#include <CLI/CLI.hpp>

#include "tools/mural/run/run_options.hpp"

namespace mural::cli {

namespace {

constexpr const char* kRunFooter = R"(Examples:
  mural run -- glxgears                                  one node, into the program's own window
  mural run --tiles 2x2 --frames 90 --out shots -- glxgears
                                                         90 frames on 4 local nodes, as PNG files
  mural run --tiles 4x2 --nodes wall1,wall2 --display windows --fullscreen -- app
  mural run --size 7680x4320 --out wall.mp4 -- app       the program sees a screen of that size
  mural run --subpixel 4 -- glxgears                     each pixel is the mean of 4 samples, one per node
  mural run --stereo anaglyph --eye-base 1 --focus 40 -- glxgears
  mural run --record app.mural -- app                    GL stream to a file, for mural replay, dump and trim
  mural run --config wall.eqc -- app                     wall, nodes and compounds from a file
  mural run --native --frames 500 -- glxgears            without Mural, for comparison

Exit status: the program's own; 128 + n after signal n; 0 if --frames ended it.
  2    the session could not start: a bad argument, no display, no GL, or a program that
       cannot be captured (setuid, static, other word size)
  126  the program cannot be executed
  127  the program was not found

MURAL_LOG=rsp:debug,output:trace prints diagnostics of these topics; MURAL_LOG=debug prints those of all. Topics and
levels are in docs/reference/logging.md.)";

} // namespace

void describeRunOptions(CLI::App& command, RunArguments& a) {
    command.option_defaults()->take_last();
    command.add_option("--tiles", a.tiles, "tiles of the wall, columns x rows (1x1, or one for each node)")
        ->type_name("CxR");
    command
        .add_option("--tile-queue", a.tileQueue,
                    "tiles of W x H pixels; nodes with less work take more of them (none: each node keeps its tiles)")
        ->type_name("WxH");
    command
        .add_option(
            "--chunk-queue", a.chunkQueue,
            "with --db: draws in N chunks; nodes with less work take more of them (none: nodes have equal ranges)")
        ->type_name("N");
    command
        .add_option("--balance", a.balance,
                    "areas of nodes, or ranges with --db, follow their times: auto (a map of the cost), load or tree "
                    "(equalizers of the file format), off (equal parts; as in the file)")
        ->type_name("KIND");
    command.add_option("--nodes", a.nodes, "render nodes on these hosts, separated by commas")->type_name("H1,H2");
    command.add_option("--local-nodes", a.localNodes, "render nodes on this machine (one per tile, at most 4)")
        ->type_name("N");
    command.add_option("--size", a.size, "size of the wall; the program runs on a private display of this size")
        ->type_name("WxH");
    command.add_option("--frames", a.frames, "end the program after N frames; later frames are not saved")
        ->type_name("N");
    command.add_option("--out", a.out, "write pictures into a folder (PNG), or a video (.mp4, .mkv, .webm, …)")
        ->type_name("DIR|VIDEO");
    command.add_option("--save", a.save, "with --out: write only these frames, counted from 1")->type_name("1,30,90");
    command.add_option("--record", a.record, "record the program's GL stream to this file, for mural replay")
        ->type_name("FILE");
    command.add_option("--config", a.config, "wall, nodes and compounds from a configuration file (.eqc)")
        ->type_name("FILE");
    command.add_option("--canvas", a.canvas, "show only this canvas of the file (all)")->type_name("NAME");
    command
        .add_option("--projection", a.projection,
                    "view of the file's screens: program (all screens form one flat picture), room (each screen as "
                    "seen by the observer), or auto: room if screens stand at angles (auto)")
        ->type_name("WHOSE");
    command.add_option("--model-unit", a.modelUnit, "length of the room's metre in the program's units (1)")
        ->type_name("N");
    command.add_option("--layout", a.layouts, "show this layout of the file's canvases; repeatable, once per canvas")
        ->type_name("NAME")
        ->take_all();
    command.add_flag("--all-local", a.allLocal, "run all nodes of the file on this machine");
    command.add_flag("--print-config", a.printConfig,
                     "print the configuration file that is equivalent to the other options, and run nothing");
    command
        .add_option("--stereo", a.stereo,
                    "render two eyes for a monoscopic program: anaglyph, side-by-side, top-bottom, quad (wall windows "
                    "with a buffer for each eye), or one eye: left, right (off)")
        ->type_name("MODE");
    command.add_option("--eye-base", a.eyeBase, "distance between the eyes, in the program's units (0.05)")
        ->type_name("D");
    command.add_option("--focus", a.focus, "distance at which both eyes converge, in the program's units (1)")
        ->type_name("D");
    command
        .add_option(
            "--subpixel", a.subpixel,
            "antialiasing: each pixel is the mean of N jittered samples; each sample is drawn by its own nodes (1)")
        ->type_name("N");
    command
        .add_option(
            "--zoom", a.zoom,
            "resolution of drawn parts relative to shown parts: below 1 faster and coarser, above 1 smooth edges (1)")
        ->type_name("Z|XxY");
    command
        .add_option("--pixel", a.pixel,
                    "interleaved pixels: each node draws every Nth column (or one pixel of each CxR) with little "
                    "memory; approximate (1)")
        ->type_name("N|CxR");
    command.add_option("--dplex", a.dplex, "time-multiplex: N nodes draw whole frames in turn (1)")->type_name("N");
    command.add_option("--db", a.db, "sort-last: N nodes draw ranges of each frame's draws, composited by depth (1)")
        ->type_name("N");
    command
        .add_option("--composition", a.composition,
                    "sort-last algorithm: serial, direct-send, binary-swap, 2-3-swap, radix-k, streaming, or auto: by "
                    "the number of nodes (auto)")
        ->type_name("HOW");
    command
        .add_option(
            "--codec", a.codec,
            "codec of transferred pictures: auto (the fastest lossless one, for nodes of other machines), lossy (the "
            "fastest of all), or a name: raw, bitplane, bitplane-zstd, lz4, zstd, yuv420, jpeg-1 to jpeg-100 (auto)")
        ->type_name("HOW");
    command
        .add_option("--display", a.display,
                    "output of the wall: app (the program's own window), windows (one per tile), none")
        ->type_name("WHERE");
    command
        .add_option("--tiling", a.tiling,
                    "exact: the pixels of one machine; culled: less work for much geometry, exact in windows with a "
                    "depth buffer; lean: less memory (exact)")
        ->type_name("HOW");
    command
        .add_option("--local-rendering", a.localRendering,
                    "off: the program's own GL draws nothing; on: it draws too (off)")
        ->type_name("WHAT");
    command.add_option("--gl", a.gl, "GL of the render nodes: auto, egl, osmesa, glx (auto)")->type_name("GL");
    command
        .add_option("--capture-via", a.captureVia,
                    "capture of the program's GL: glvnd, preload (also the program's own GL library), auto: by the "
                    "program's libraries (auto)")
        ->type_name("WAY");
    command.add_option("--latency", a.latency, "number of frames that the program may be ahead of the wall (1)")
        ->type_name("N");
    command.add_flag("--verify{1}", a.verify, "compare every frame (=N: every Nth) with the program's own picture");
    command.add_flag("--fullscreen", a.fullScreen, "wall windows without borders, one per monitor");
    command.add_option("--position", a.position, "upper left corner of the wall windows on the screen")
        ->type_name("X,Y");
    command.add_flag("--no-placement", a.noPlacement, "leave thread placement to the kernel");
    command.add_flag("--explain", a.explain, "print the selected decomposition and rewriting, with reasons");
    command.add_flag("--native", a.native, "run without Mural; count frames and time");
    command.add_option("--launch", a.launch, "command that runs a command on a host (ssh -o BatchMode=yes)")
        ->type_name("CMD");
    command
        .add_option("--stream", a.stream,
                    "transport of the stream to other machines: auto (multicast for two or more), tcp, or "
                    "rsp://GROUP:PORT?interface=…&rate=… (auto)")
        ->type_name("HOW");
    command
        .add_option("--readback", a.readback,
                    "readback of pictures: direct (before the next frame), buffer (asynchronous, in another thread), "
                    "auto: the one that costs the drawing thread less (auto)")
        ->type_name("HOW");
    command
        .add_option("--delta", a.delta,
                    "delta coding, which sends data to a node only once: auto (nodes of other machines), on (all "
                    "nodes), off (auto)")
        ->type_name("WHICH");
    command
        .add_option("--cache-size", a.cacheSize,
                    "memory of the delta cache, in the head and in each of those nodes (1GiB)")
        ->type_name("SIZE");
    command.add_option("--restart-nodes", a.restartNodes, "restart a lost node up to N times in a row; 0: never (3)")
        ->type_name("N");
    command.add_option("--min-nodes", a.minNodes, "begin with N nodes; late or failed ones join later (all)")
        ->type_name("N");
    command.add_option("--remote-mural", a.remoteMural, "path of mural on the hosts (the local path)")
        ->type_name("PATH");
    command.add_option("--report", a.report, "write the final report to this file, as one line of JSON")
        ->type_name("FILE");
    command.add_flag("--quiet", a.quiet, "print only errors");
    command.footer(kRunFooter);
}

} // namespace mural::cli
