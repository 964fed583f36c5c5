#include "nodes/head/planning/unsupported_fields.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace mural {

namespace {

struct Gap {
    std::string_view section; // empty: any section
    std::string_view field;
    std::string_view instead; // the actual behaviour and a remedy
};

constexpr std::string_view kNoTransport = "the host name selects the transport; remove it";
constexpr std::string_view kNoCounts = "mural stat shows the nodes' statistics";
constexpr std::string_view kAsProgram =
    "nodes draw with the format of the program's windows; change the program's settings";

constexpr std::array kGaps = {
    Gap{"node", "connection", kNoTransport},
    Gap{"appNode", "connection", kNoTransport},
    Gap{"", "hint_statistics", kNoCounts},
    Gap{"", "hint_sendtoken", "each node sends its picture after drawing; remove it"},
    Gap{"", "dump_image", "use mural run --out DIR --save N"},
    Gap{"", "hint_thread", "each node is one process and places its threads itself (--no-placement: not at all)"},
    Gap{"", "hint_affinity", "nodes place their threads themselves (--no-placement: not at all)"},
    Gap{"", "thread_model", "a frame is shown when all of its parts have arrived; remove it"},
    Gap{"", "launch_command", "use mural run --launch"},
    Gap{"", "launch_command_quote", "use mural run --launch"},
    Gap{"", "launch_timeout", "the time limit for node starts is fixed; remove it"},
    Gap{"", "hint_core_profile", kAsProgram},
    Gap{"", "hint_opengl_major", kAsProgram},
    Gap{"", "hint_opengl_minor", kAsProgram},
    Gap{"", "hint_doublebuffer", kAsProgram},
    Gap{"", "planes_color", kAsProgram},
    Gap{"", "planes_alpha", kAsProgram},
    Gap{"", "planes_depth", kAsProgram},
    Gap{"", "planes_stencil", kAsProgram},
    Gap{"", "planes_accum", kAsProgram},
    Gap{"", "planes_accum_alpha", kAsProgram},
    Gap{"", "planes_samples", "nodes draw with the format of the program's windows; --subpixel adds antialiasing"},
    Gap{"", "hint_decoration", "wall windows have no decoration; remove it"},
    Gap{"", "hint_swapsync", "a swapbarrier synchronizes windows; the driver's settings control vertical sync"},
    Gap{"", "hint_screensaver", "disable the screen saver on the machines of the wall (xset s off)"},
    Gap{"", "hint_grab_pointer", "the program receives the pointer; remove it"},
    Gap{"", "opencv_camera", "head tracking is not supported; the eyes stay at the file's position"},
    Gap{"", "vrpn_tracker", "head tracking is not supported; the eyes stay at the file's position"},
    Gap{"", "deflect_host", "views are not streamed to other walls; remove it"},
    Gap{"", "robustness", "the session always continues without lost nodes; remove it"},
    Gap{"", "NV_group", "barriers use the network, without hardware; remove it"},
    Gap{"", "NV_barrier", "barriers use the network, without hardware; remove it"},
};

} // namespace

std::vector<std::string> fieldsWithoutEffect(const config::Diagnostics& read) {
    std::vector<std::string> lines;
    for (const config::GivenField& g : read.fieldsGiven()) {
        const auto gap = std::ranges::find_if(
            kGaps, [&](const Gap& c) { return c.field == g.field && (c.section.empty() || c.section == g.section); });
        if (gap == kGaps.end()) continue;
        const std::string times = g.times == 1 ? "" : " (" + std::to_string(g.times) + " times)";
        lines.push_back(read.text({config::Severity::Warning, g.at, g.field + times + " has no effect in a session",
                                   std::string(gap->instead)}));
    }
    return lines;
}

} // namespace mural
