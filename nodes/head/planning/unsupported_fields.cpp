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

constexpr std::string_view kNoTransport = "nodes are reached by their host; mural run says how; remove it";
constexpr std::string_view kNoCounts = "mural stat shows what nodes take";
constexpr std::string_view kNoBalance =
    "its areas or ranges are divided evenly; give its compounds a viewport or a range where some are dearer";
constexpr std::string_view kAsProgram = "nodes draw as the program's own windows are; change the program's settings";

constexpr std::array kGaps = {
    Gap{"node", "connection", kNoTransport},
    Gap{"appNode", "connection", kNoTransport},
    Gap{"", "hint_statistics", kNoCounts},
    Gap{"", "hint_sendtoken", "each node sends its picture when it is drawn; remove it"},
    Gap{"", "dump_image", "mural run --out DIR --save N keeps pictures"},
    Gap{"", "hint_thread", "each node is a process, its threads are placed by themselves (--no-placement: not at all)"},
    Gap{"", "hint_affinity", "threads are placed by themselves (--no-placement: not at all)"},
    Gap{"", "thread_model", "a frame is shown when all of its parts are there; remove it"},
    Gap{"", "launch_command", "mural run --launch says how nodes are started"},
    Gap{"", "launch_command_quote", "mural run --launch says how nodes are started"},
    Gap{"", "launch_timeout", "how long nodes are waited for can't be changed; remove it"},
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
    Gap{"", "planes_samples", "nodes draw as the program's own windows are; --subpixel smooths edges of any program"},
    Gap{"", "hint_decoration", "windows of nodes are bare parts of the wall; remove it"},
    Gap{"", "hint_swapsync", "a swapbarrier makes windows change together; the driver's settings tell when"},
    Gap{"", "hint_screensaver", "turn it off on the machines of the wall (xset s off)"},
    Gap{"", "hint_grab_pointer", "the program has the pointer; remove it"},
    Gap{"", "opencv_camera", "heads are not tracked, the eyes stay where the file puts them"},
    Gap{"", "vrpn_tracker", "heads are not tracked, the eyes stay where the file puts them"},
    Gap{"", "deflect_host", "views are not sent to other walls; remove it"},
    Gap{"", "robustness", "nodes may always be lost, the others go on; remove it"},
    Gap{"", "NV_group", "barriers wait over the network, without hardware; remove it"},
    Gap{"", "NV_barrier", "barriers wait over the network, without hardware; remove it"},
    Gap{"compound", "load_equalizer", kNoBalance},
    Gap{"compound", "tree_equalizer", kNoBalance},
    Gap{"compound", "view_equalizer", "every view is drawn by all of its channels; remove it"},
    Gap{"compound", "DFR_equalizer", "pictures keep their size; give the compound a fixed zoom"},
    Gap{"compound", "framerate_equalizer", "frames are shown as they come; remove it"},
    Gap{"compound", "monitor_equalizer", "mural_copy_to in a segment shows its picture elsewhere, too"},
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
