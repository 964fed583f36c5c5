// Warns the user once about each window whose picture has fewer bits per channel than the window.
#pragma once

#include <cstdint>
#include <set>
#include <utility>

#include "nodes/player/player_setup.hpp"

namespace mural {

class LostBitsNotice {
public:
    void report(const PlayerOutputs::Frame& frame);
    void windowGone(uint32_t client, uint32_t window) { reported_.erase({client, window}); }
    void clientGone(uint32_t client);

private:
    std::set<std::pair<uint32_t, uint32_t>> reported_; // client, window
};

} // namespace mural
