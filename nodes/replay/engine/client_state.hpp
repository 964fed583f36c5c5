// The objects of one captured program on this node, and the position of each of its streams.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <unordered_map>
#include <vector>

#include "nodes/gl/gl_platform.hpp"
#include "nodes/replay/context/context_state.hpp"
#include "nodes/replay/context/window_state.hpp"

namespace mural::replay {

struct Stream {
    ContextState* context = nullptr;
    Window* draw = nullptr;
    Window* read = nullptr;
    std::deque<std::vector<std::byte>> blobs;
    uint64_t blobMissing = 0; // bytes of the last blob that have not arrived
    uint64_t blobBytes = 0;   // size of all blobs when complete
};

struct Client {
    std::map<uint32_t, std::unique_ptr<ContextState>> contexts;
    std::map<uint32_t, std::unique_ptr<Window>> windows;
    std::map<uint32_t, Stream> streams;
    std::unordered_map<uint64_t, std::unique_ptr<gl::Image>> images; // by the program's handle
    bool anyDestroyed = false;
};

} // namespace mural::replay
