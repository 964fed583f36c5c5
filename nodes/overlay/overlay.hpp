// The overlay of this process: its mode and numbers. Windows draw it over their pictures, each on its own thread.
// Thread-safe.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "nodes/overlay/overlay_content.hpp"

namespace mural {

class Overlay {
public:
    Overlay(std::string host, std::string role);

    void setMode(OverlayMode mode);
    [[nodiscard]] OverlayMode mode() const { return mode_.load(std::memory_order_acquire); }
    // Replaces the numbers for `stats`.
    void setNodes(std::vector<OverlayNode> nodes);

    // Changes with each other content. Windows then draw the overlay anew with their next picture.
    [[nodiscard]] uint64_t version() const { return version_.load(std::memory_order_acquire); }
    [[nodiscard]] OverlayContent content() const;

private:
    std::atomic<OverlayMode> mode_{OverlayMode::Off};
    std::atomic<uint64_t> version_{1};
    mutable std::mutex mutex_; // guards the next member
    OverlayContent content_;
};

} // namespace mural
