// Messages of the fabric transport, little-endian.
//
// Each message fills one receive buffer: a header of 8 bytes (u8 kind, u8 0, u16 credits, u32 0), followed by stream
// bytes for Data. Data consumes a credit of its sender. The receiver returns credits as its reader empties buffers, a
// quarter of the window at once. So at most four credit messages and one Bye occupy receive buffers besides a window of
// Data; buffers for them are reserved, and a receiver never runs out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "common/base/little_endian.hpp"

namespace mural::fabric {

inline constexpr size_t kHeaderBytes = 8;
inline constexpr size_t kMessageBytes = size_t{64} << 10; // including its header; size of a buffer at either end
inline constexpr uint16_t kWindow = 16;                   // unread Data messages
inline constexpr uint16_t kCreditsAtOnce = kWindow / 4;
inline constexpr size_t kControls = 6;
inline constexpr size_t kReceives = kWindow + kControls;
inline constexpr size_t kSends = kWindow + 1; // one is filled while a window is in flight

enum class MessageKind : uint8_t { Data = 1, Credit = 2, Bye = 3 };

using Header = std::array<std::byte, kHeaderBytes>;

inline Header makeHeader(MessageKind kind, uint16_t credits = 0) {
    Header header{};
    header[0] = static_cast<std::byte>(kind);
    storeLittle<uint16_t>(header.data() + 2, credits);
    return header;
}

// Part of the connection request and its reply: the limits of the sender.
struct Greeting {
    uint32_t messageBytes = kMessageBytes;
    uint16_t window = kWindow;
};

inline constexpr size_t kGreetingBytes = 16;
inline constexpr char kGreetingMagic[] = "MURALFB\1"; // the last byte is the version

inline std::array<std::byte, kGreetingBytes> makeGreeting() {
    std::array<std::byte, kGreetingBytes> bytes{};
    std::memcpy(bytes.data(), kGreetingMagic, 8);
    storeLittle<uint32_t>(bytes.data() + 8, kMessageBytes);
    storeLittle<uint16_t>(bytes.data() + 12, kWindow);
    return bytes;
}

// Parses a greeting. Rejects other magics, other versions, and unusable limits. Providers may append zeros.
inline std::optional<Greeting> readGreeting(std::span<const std::byte> bytes) {
    if (bytes.size() < kGreetingBytes || std::memcmp(bytes.data(), kGreetingMagic, 8) != 0) return {};
    const Greeting greeting{loadLittle<uint32_t>(bytes.data() + 8), loadLittle<uint16_t>(bytes.data() + 12)};
    if (greeting.messageBytes <= kHeaderBytes || greeting.window == 0) return {};
    return greeting;
}

} // namespace mural::fabric
