// The end of a frame in a publication. A program publishes a swap as the last record of a publication.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "streamcodec/wire/control_records.hpp"

namespace mural {

struct FrameEnd {
    static constexpr size_t kBytes = 12; // size of the record
    uint32_t window = 0;
    uint32_t frame = 0; // or wire::kUnseenFrame
};

// Returns the frame that the last record ends, if any.
inline std::optional<FrameEnd> frameEndOf(std::span<const std::byte> records) {
    std::array<uint32_t, 3> last{}; // header, window, frame
    static_assert(sizeof last == FrameEnd::kBytes);
    if (records.size() < sizeof last) return {};
    std::memcpy(last.data(), records.data() + records.size() - sizeof last, sizeof last);
    constexpr uint32_t kWords = 3U << 16;
    if (last[0] != (wire::kOpSwap | kWords) && last[0] != (wire::kOpFrontPicture | kWords)) return {};
    return FrameEnd{last[1], last[2]};
}

} // namespace mural
