#include "tools/mural/config/config_summary.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

#include "balancer/config/eqc/section_fields.hpp"

namespace mural::cli {

namespace {

std::string counted(size_t count, const std::string& one) {
    const bool irregular = one == "canvas";
    return fmt::format("{} {}{}", count, one, count == 1 ? "" : irregular ? "es" : "s");
}

std::string versionText(double version) {
    return version > 0 ? fmt::format("Equalizer's format {}", version) : "Equalizer's format, without a header";
}

} // namespace

std::vector<std::string> summaryOf(const compound::LoadedConfig& loaded) {
    const config::ResolvedConfig& c = loaded.resolved;
    const auto destinations = static_cast<size_t>(
        std::count_if(c.channels.begin(), c.channels.end(), [](const auto& one) { return one.isDestination(); }));
    std::vector<std::string> lines;
    lines.push_back("format      " + versionText(loaded.file.version));
    lines.push_back(fmt::format("resources   {}, {}, {}, {}", counted(c.nodes.size(), "node"),
                                counted(c.pipes.size(), "pipe"), counted(c.windows.size(), "window"),
                                counted(c.channels.size() - destinations, "channel")));
    lines.push_back(fmt::format("displays    {} with {}, {} with {}, {}", counted(c.canvases.size(), "canvas"),
                                counted(c.segments.size(), "segment"), counted(c.layouts.size(), "layout"),
                                counted(c.views.size(), "view"), counted(destinations, "destination channel")));
    size_t outputs = 0, generated = 0;
    std::map<std::string, size_t> equalizers;
    for (const config::ResolvedCompound& one : c.compounds) {
        outputs += one.outputFrames.size();
        generated += one.isGenerated ? 1 : 0;
        for (const config::Equalizer& e : one.equalizers)
            ++equalizers[std::string(std::visit([](const auto& which) { return config::sectionName(which); }, e))];
    }
    const std::string unwritten = generated > 0 ? fmt::format(" ({} of them created by default)", generated) : "";
    lines.push_back(fmt::format("compounds   {}{} in {}, {}", counted(c.compounds.size(), "compound"), unwritten,
                                counted(c.roots.size(), "tree"), counted(outputs, "frame")));
    if (!equalizers.empty()) {
        std::string names;
        for (const auto& [name, count] : equalizers)
            names += (names.empty() ? "" : ", ") + (count > 1 ? fmt::format("{} {}", count, name) : name);
        lines.push_back("equalizers  " + names);
    }
    lines.push_back(fmt::format("latency     {}", counted(c.latency, "frame")));
    return lines;
}

} // namespace mural::cli
