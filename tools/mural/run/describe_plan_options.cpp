// The options of `mural run` that divide the work, as the help lists them. `mural change` has them, too.
#include <CLI/CLI.hpp>

#include "tools/mural/run/run_options.hpp"

namespace mural::cli {

void describePlanOptions(CLI::App& command, RunArguments& a) {
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
        .add_option("--tiling", a.tiling,
                    "exact: the pixels of one machine; culled: less work for much geometry, exact in windows with a "
                    "depth buffer; lean: less memory (exact)")
        ->type_name("HOW");
    command
        .add_option("--readback", a.readback,
                    "readback of pictures: direct (before the next frame), buffer (asynchronous, in another thread), "
                    "auto: the one that costs the drawing thread less (auto)")
        ->type_name("HOW");
}

} // namespace mural::cli
