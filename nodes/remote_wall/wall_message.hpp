// Messages between a sender of pictures (mural run --send) and a remote wall (mural show): their contents, and their
// encoding. Layout: docs/reference/remote-walls.md. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/base/result.hpp"
#include "common/geometry/pixel_viewport.hpp"
#include "nodes/input/input_event.hpp"

namespace mural::remote {

inline constexpr uint32_t kWallVersion = 1; // also of the codec numbers
inline constexpr int kMinTile = 64, kMaxTile = 2048;
inline constexpr int kMaxEyes = 2;
inline constexpr int kMaxPictureSide = 32'767;
inline constexpr int64_t kMaxPicturePixels = int64_t{1} << 28; // of all eyes
inline constexpr uint32_t kMaxSources = 256;
inline constexpr int kMaxRate = 240; // frames per second
inline constexpr size_t kMaxMessageBytes = (size_t{4} * kMaxTile * kMaxTile) + 64;

// First message in both directions.
struct Hello {
    uint32_t version = kWallVersion; // the other members follow only if it is kWallVersion
    std::string name;                // of the session's wall, or of the machine with the windows
    std::string codec;               // of the tiles: a name for PlaneEncoder
    uint64_t session = 0;            // of the sender; differs between sessions
    int width = 0, height = 0;       // of the remote wall: larger pictures are reduced; 0: the pictures determine it
    int eyes = 1;
    int tile = 0;                     // side in pixels
    uint32_t source = 0, sources = 1; // of this connection; number of all sources
    bool operator==(const Hello&) const = default;
};

struct PictureSize {
    int width = 0, height = 0, eyes = 1;
    bool operator==(const PictureSize&) const = default;
    [[nodiscard]] int64_t pixels() const { return int64_t{width} * height * eyes; }
};

// A changed tile. Its pixels are BGRA, or RGBA with a lossy codec; the lowest row comes first.
struct Tile {
    uint64_t frame = 0; // number of the sent frames, from 1; all sources use the same
    PictureSize size;
    int eye = 0;
    PixelViewport area; // in pixels of the picture, from the lower left corner
    uint8_t codec = 0;  // CodecNumber
    std::span<const std::byte> bytes;
};

// The source has sent all its tiles of the frame.
struct FrameEnd {
    uint64_t frame = 0;
    PictureSize size;
    uint32_t tiles = 0;
    bool isWhole = false;   // the source has sent its unchanged tiles as well
    uint64_t wallFrame = 0; // number of the session's frame, for files
    bool operator==(const FrameEnd&) const = default;
};

// The remote wall has shown this frame, and forgets all earlier ones.
struct Ack {
    uint64_t frame = 0;
    uint64_t shownNs = 0; // time from the frame's end to its display
    bool operator==(const Ack&) const = default;
};

// Limits of the remote wall for the frames that follow.
struct Want {
    int rate = 0;              // most frames per second; 0: the sender's choice
    int width = 0, height = 0; // as in Hello
    bool isWhole = false;      // the next frame must have all tiles
    bool operator==(const Want&) const = default;
};

struct Event {
    input::InputEvent input;
};

// Last message: the reason for the end, one line.
struct Bye {
    std::string reason;
    bool isFinal = false; // a further connection would end in the same way
    bool operator==(const Bye&) const = default;
};

using Message = std::variant<Hello, Tile, FrameEnd, Ack, Want, Event, Bye>;

[[nodiscard]] std::vector<std::byte> encode(const Message& message);
// Accepts arbitrary bytes. The bytes of a Tile remain a part of `bytes`. Errors: no message of this version.
[[nodiscard]] Result<Message> parseMessage(std::span<const std::byte> bytes);

} // namespace mural::remote
