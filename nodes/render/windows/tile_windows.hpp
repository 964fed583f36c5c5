// The wall windows of one node: one per tile, or one for its area.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "common/base/main_window.hpp"
#include "nodes/output/windows/wall_windows.hpp"
#include "nodes/render/windows/overlay_part.hpp"
#include "nodes/render/windows/shown_tiles.hpp"
#include "nodes/player/player_setup.hpp"
#include "nodes/session/session_config.hpp"
#include "nodes/swap_barrier/swap_barrier.hpp"

namespace mural {

class TileWindows {
public:
    // onInput: takes the events of the windows, on their thread; empty: none.
    using OnInput = std::function<void(const input::InputEvent& event)>;
    static Result<std::unique_ptr<TileWindows>> open(const NodeSetup& setup, OnInput onInput);
    // The overlay over the pictures. Never null.
    [[nodiscard]] const std::shared_ptr<OverlayPart>& overlay() const { return overlay_; }
    // Shows the tiles of the main window (the largest that swaps). With a barrier, waits for its other members.
    Result<void> show(const PlayerOutputs::Frame& frame, SwapBarrier* barrier);
    // The tiles in the windows; null: none yet.
    [[nodiscard]] const std::shared_ptr<const ShownTiles>& shown() const { return shown_; }

    void windowGone(uint32_t client, uint32_t window) { mainWindow_.windowGone(client, window); }
    void clientGone(uint32_t client) { mainWindow_.clientGone(client); }

private:
    TileWindows(const NodeSetup& setup, OnInput onInput)
        : setup_(setup), onInput_(std::move(onInput)), overlay_(std::make_shared<OverlayPart>(setup)) {}
    [[nodiscard]] std::vector<TileWindow> windowsFor(int width, int height) const;
    Result<void> reopen(int width, int height);
    static int64_t awaitBarrier(SwapBarrier& barrier, const SwapKey& key);
    Result<int64_t> present(std::span<const WallWindows::TilePicture> pictures, const SwapKey& key,
                            SwapBarrier* barrier);

    NodeSetup setup_;
    const OnInput onInput_;
    const std::shared_ptr<OverlayPart> overlay_;
    std::unique_ptr<WallWindows> windows_;
    int width_ = 0, height_ = 0;
    MainWindow mainWindow_;
    std::vector<PixelViewport> tiles_;
    std::shared_ptr<const ShownTiles> shown_;
};

} // namespace mural
