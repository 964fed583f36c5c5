// The options of `mural run` as its help lists them.
#include <CLI/CLI.hpp>

#include "tools/mural/run/run_options.hpp"

namespace mural::cli {

namespace {

void describeLaunchOptions(CLI::App& command, RunArguments& a) {
    a.startsNodes = true;
    command
        .add_option("--launch", a.launch,
                    "way to start nodes on hosts: auto, local (this machine), ssh, slurm, pmix, or a command that runs "
                    "a command on a host (auto: slurm inside of a job, otherwise ssh)")
        ->type_name("HOW");
    command
        .add_option("--hostfile", a.hostFile, "hosts of the nodes, one per line, each with slots=N for N nodes (none)")
        ->type_name("FILE");
    command.add_option("--per-host", a.perHost, "nodes on each host of --nodes, --hostfile or the batch job (1)")
        ->type_name("N");
    command
        .add_option("--slurm", a.slurm,
                    "outside of a Slurm job: request one with these options of salloc, such as \"-N4 -t 60\", and run "
                    "in it")
        ->type_name("OPTIONS");
    command
        .add_option(
            "--secret", a.launchSecret,
            "file with the secret of waiting nodes (mural node --wait), which --nodes names @NAME, and of remote walls")
        ->type_name("FILE");
    command
        .add_option("--start-timeout", a.startTimeout,
                    "seconds for the connections of all nodes, and again for their GL (30)")
        ->type_name("SECONDS");
}

constexpr const char* kRunFooter = R"(Examples:
  mural run -- glxgears                                  one node, into the program's own window
  mural run --tiles 2x2 --frames 90 --out shots -- glxgears
                                                         90 frames on 4 local nodes, as PNG files
  mural run --tiles 4x2 --nodes wall1,wall2 --display windows --fullscreen -- app
  mural run --slurm "-N4 -t 60" --tiles 2x2 -- app       nodes on the four hosts of a new Slurm job
  mpirun -n 5 mural run --tiles 2x2 -- app               nodes are the ranks 1 to 4
  mural run --size 7680x4320 --out wall.mp4 -- app       the program sees a screen of that size
  mural run --subpixel 4 -- glxgears                     each pixel is the mean of 4 samples, one per node
  mural run --stereo anaglyph --eye-base 1 --focus 40 -- glxgears
  mural run --secret key --send museum=wall.example:4281 -- app
                                                         pictures for mural show on another machine
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
    describePlanOptions(command, a);
    command.add_option("--size", a.size, "size of the wall; the program runs on a private display of this size")
        ->type_name("WxH");
    command.add_option("--frames", a.frames, "end the program after N frames; later frames are not saved")
        ->type_name("N");
    command.add_option("--out", a.out, "write pictures into a folder (PNG), or a video (.mp4, .mkv, .webm, …)")
        ->type_name("DIR|VIDEO");
    command.add_option("--save", a.save, "with --out: write only these frames, counted from 1")->type_name("1,30,90");
    command
        .add_option("--send", a.sends,
                    "send the pictures to a remote wall (mural show --listen), with codec=, tile=, rate=, input= and "
                    "secret= after commas; may be repeated")
        ->type_name("NAME=HOST:PORT")
        ->allow_extra_args(false)
        ->take_all();
    command.add_option("--record", a.record, "record the program's GL stream to this file, for mural replay")
        ->type_name("FILE");
    command.add_flag("--print-config", a.printConfig,
                     "print the configuration file that is equivalent to the other options, and run nothing");
    command
        .add_option("--display", a.display,
                    "output of the wall: app (the program's own window), windows (one per tile), none")
        ->type_name("WHERE");
    command
        .add_option("--culling", a.culling,
                    "auto: a node leaves out vertices that cannot touch its tiles; audit: it also counts the samples "
                    "of everything that it leaves out, and the run fails if one is in its tiles; off (off)")
        ->type_name("HOW");
    command
        .add_option("--local-rendering", a.localRendering,
                    "off: the program's own GL draws nothing; on: it draws too (off)")
        ->type_name("WHAT");
    command.add_option("--gl", a.gl, "GL of the render nodes: auto, egl, osmesa, glx (auto)")->type_name("GL");
    command
        .add_option(
            "--gpus", a.gpus,
            "GPUs of the nodes of each machine: auto (in turn), first, or a list that they take in turn: number, "
            "UUID, DRM node or PCI address as in mural doctor --nodes (auto)")
        ->type_name("GPUS");
    command
        .add_option("--capture-via", a.captureVia,
                    "capture of the program's GL: glvnd, preload (also the program's own GL library), auto: by the "
                    "program's libraries (auto)")
        ->type_name("WAY");
    command.add_option("--latency", a.latency, "number of frames that the program may be ahead of the wall (1)")
        ->type_name("N");
    command.add_option("--overlay", a.overlay, "drawn over the wall's windows: off, stats, names, grid (off)")
        ->type_name("MODE");
    command
        .add_option("--window-input", a.windowInput,
                    "pointer and keys of the wall windows for the program: off; on: if it is on a private display; "
                    "display: also on your own, whose pointer then moves (on)")
        ->type_name("MODE");
    command.add_flag("--overlay-in-files", a.overlayInFiles, "the overlay also in the pictures of --out");
    command.add_flag("--verify{1}", a.verify, "compare every frame (=N: every Nth) with the program's own picture");
    command.add_flag("--page{127.0.0.1}", a.page,
                     "open a page that shows and steers the wall in a browser (=ADDRESS: there, as mural page --at)");
    command.add_flag("--fullscreen", a.fullScreen, "wall windows without borders, one per monitor");
    command.add_option("--position", a.position, "upper left corner of the wall windows on the screen")
        ->type_name("X,Y");
    command.add_flag("--no-placement", a.noPlacement, "leave thread placement to the kernel");
    command.add_flag("--explain", a.explain, "print the selected decomposition and rewriting, with reasons");
    command.add_flag("--native", a.native, "run without Mural; count frames and time");
    describeLaunchOptions(command, a);
    command
        .add_option("--stream", a.stream,
                    "transport of the stream to other machines: auto (multicast for two or more), tcp, or "
                    "rsp://GROUP:PORT?interface=…&rate=… (auto)")
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
    command
        .add_option("--spare-nodes", a.spareNodes,
                    "hosts, separated by commas, that take over the nodes of a host whose node cannot be restarted")
        ->type_name("H1,H2");
    command.add_option("--min-nodes", a.minNodes, "begin with N nodes; late or failed ones join later (all)")
        ->type_name("N");
    command
        .add_option("--remote-mural", a.remoteMural,
                    "path of mural, or of a program with the native API, on the hosts (the local path)")
        ->type_name("PATH");
    command
        .add_option("--node-program", a.nodeProgram,
                    "program with the native API that the nodes run, if a script starts it (the program itself)")
        ->type_name("PATH");
    command.add_option("--report", a.report, "write the final report to this file, as one line of JSON")
        ->type_name("FILE");
    command
        .add_option("--frame-times", a.frameTimes,
                    "write the work of each node for each frame to this file, as lines of JSON")
        ->type_name("FILE");
    command.add_flag("--quiet", a.quiet, "print only errors");
    command.footer(kRunFooter);
}

} // namespace mural::cli
