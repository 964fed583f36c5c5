#include "tools/mural/hosts/expected_screens.hpp"

#include "balancer/compound/load_config.hpp"

namespace mural::cli {

Result<std::map<std::string, std::vector<ExpectedScreen>>> expectedScreens(const std::string& file) {
    const compound::LoadedConfig loaded = compound::loadConfig(file, compound::processEnvironment);
    if (!loaded.ok()) return Error{"--config: " + loaded.diagnostics.firstError() + "; see mural config check " + file};
    const config::ResolvedConfig& c = loaded.resolved;
    const compound::DisplaySizes sizes = compound::displaySizes(c);
    std::map<std::string, std::vector<ExpectedScreen>> screens;
    for (const config::ResolvedNode& node : c.nodes) {
        auto& ofHost = screens[node.host];
        for (const compound::Index pipeIndex : node.pipes) {
            const config::ResolvedPipe& pipe = c.pipes[compound::at(pipeIndex)];
            ExpectedScreen screen;
            if (pipe.device || pipe.port)
                screen.display =
                    ":" + std::to_string(pipe.port.value_or(0)) + "." + std::to_string(pipe.device.value_or(0));
            if (pipe.viewport) {
                screen.width = pipe.viewport->w;
                screen.height = pipe.viewport->h;
            }
            for (const compound::Index windowIndex : pipe.windows) {
                const config::ResolvedWindow& window = c.windows[compound::at(windowIndex)];
                const PixelViewport& place = sizes.windows[compound::at(windowIndex)];
                if (!pipe.viewport && !config::inPixels(window.viewport)) continue; // relative to an unknown screen
                screen.windows.push_back({window.name, place.x, place.y, place.w, place.h,
                                          window.attributes.hintFullscreen == config::value::kOn});
            }
            ofHost.push_back(std::move(screen));
        }
    }
    return screens;
}

} // namespace mural::cli
