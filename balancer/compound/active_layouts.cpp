#include "balancer/compound/active_layouts.hpp"

#include <algorithm>

namespace mural::compound {

namespace {

constexpr const char* kOff = "off";

template <class IsWanted> bool activate(const ResolvedConfig& config, FrameInput& input, IsWanted&& isWanted) {
    bool found = false;
    for (size_t c = 0; c < config.canvases.size(); ++c) {
        const auto& layouts = config.canvases[c].layouts;
        for (size_t i = 0; i < layouts.size(); ++i) {
            if (layouts[i] == kNone || !isWanted(config.canvases[c], layouts[i])) continue;
            input.activeLayouts[c] = static_cast<Index>(i);
            found = true;
        }
    }
    return found;
}

} // namespace

bool activateLayout(const ResolvedConfig& config, const std::string& wanted, FrameInput& input) {
    input.activeLayouts.resize(config.canvases.size(), 0);
    bool isOff = false;
    for (size_t c = 0; c < config.canvases.size(); ++c) {
        const std::string& name = config.canvases[c].name;
        if (name.empty() || wanted != name + ":" + kOff) continue;
        input.activeLayouts[c] = kNone;
        isOff = true;
    }
    const auto byName = [&](const config::ResolvedCanvas& canvas, Index layout) {
        const std::string& name = config.layouts[at(layout)].name;
        return name == wanted || (!canvas.name.empty() && wanted == canvas.name + ":" + name);
    };
    const auto byNumber = [&](const config::ResolvedCanvas&, Index layout) { return std::to_string(layout) == wanted; };
    return isOff || activate(config, input, byName) || activate(config, input, byNumber);
}

} // namespace mural::compound
