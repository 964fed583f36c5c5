// The header of a part of a picture in a binary WebSocket message (docs/reference/page.md). Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace mural::page {

enum class PartKind : uint8_t { Jpeg = 1, H264 = 2, Cursor = 3, Png = 4 };

inline constexpr uint8_t kPartVersion = 1;
inline constexpr uint16_t kKeyFrame = 1, kLastOfFrame = 2, kStill = 4, kHidden = 8;
inline constexpr size_t kPartHeaderBytes = 36;

struct PartHeader {
    PartKind kind = PartKind::Jpeg;
    uint16_t flags = 0;
    uint32_t stream = 0; // 0: the wall; 1 + N: node N
    uint64_t frame = 0;
    uint32_t lastInput = 0;
    // Pixels of the class's picture, from the upper left corner. Of a cursor: its place in 1/65535 of the picture, and
    // its hot spot.
    uint16_t x = 0, y = 0, width = 0, height = 0;
    uint16_t pictureWidth = 0, pictureHeight = 0;
};

// Returns the bytes of the header. The payload of that size follows them.
[[nodiscard]] std::string partHeaderBytes(const PartHeader& header, size_t payloadBytes);

} // namespace mural::page
