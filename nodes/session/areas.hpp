// Areas of the nodes, for sessions in which areas change (HeadCommand::Areas).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/viewport.hpp"

namespace mural {

struct Areas {
    uint32_t number = 0; // 0: the initial areas; increases
    std::vector<Viewport> ofNodes; // per node; neighbours share bit-identical edges

    friend bool operator==(const Areas&, const Areas&) = default;
};

// u32 number, u32 nodes, then four doubles per node: x, y, w, h.
std::vector<std::byte> bytesOf(const Areas& areas);

// Parses areas at the start of `bytes` and removes them. Returns nothing if truncated, or if an area exceeds the
// picture.
std::optional<Areas> takeAreas(std::span<const std::byte>& bytes);

} // namespace mural
