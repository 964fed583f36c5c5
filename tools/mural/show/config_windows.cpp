#include "tools/mural/show/config_windows.hpp"

#include "balancer/compound/load_config.hpp"
#include "nodes/head/planning/config/canvas_choice.hpp"

namespace mural::cli {

Result<ConfigWall> configWindows(const std::string& file) {
    const compound::LoadedConfig loaded = compound::loadConfig(file, compound::processEnvironment);
    if (!loaded.ok()) return Error{"--config: " + loaded.diagnostics.firstError() + "; see mural config check " + file};
    const config::ResolvedConfig& c = loaded.resolved;
    if (c.canvases.empty())
        return Error{"--config " + file + ": it has no canvas, so no window has a place; use --size"};
    const compound::PixelSize size = canvasSize(c, 0);
    const compound::DisplaySizes sizes = compound::displaySizes(c);
    ConfigWall wall{size.w, size.h, false, {}};
    for (const config::Index s : c.canvases.front().segments) {
        const config::ResolvedSegment& segment = c.segments[config::at(s)];
        if (segment.channel == config::kNone || segment.viewport.empty()) continue;
        const config::ResolvedChannel& channel = c.channels[config::at(segment.channel)];
        const PixelViewport& window = sizes.windows[config::at(channel.window)];
        const PixelViewport& inWindow = sizes.channels[config::at(segment.channel)];
        wall.isFullScreen =
            wall.isFullScreen || c.windows[config::at(channel.window)].attributes.hintFullscreen == config::value::kOn;
        wall.windows.push_back({channel.name, segment.viewport, window.x + inWindow.x, window.y + inWindow.y});
    }
    if (wall.windows.empty() || size.w <= 0 || size.h <= 0)
        return Error{"--config " + file + ": its first canvas has no channel of a known size; see mural config check"};
    return wall;
}

std::vector<TileWindow> windowsFor(const ConfigWall& wall, int width, int height) {
    std::vector<TileWindow> windows;
    for (const ConfigWindow& window : wall.windows) {
        TileWindow shown;
        shown.tile = apply(PixelViewport{0, 0, width, height}, window.part);
        shown.screenX = window.x;
        shown.screenY = window.y;
        shown.title = "Mural " + window.name;
        windows.push_back(shown);
    }
    return windows;
}

} // namespace mural::cli
