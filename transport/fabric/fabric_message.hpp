// What two ends say to each other. Numbers are little endian.
//
// Each message fills one of the receiver's buffers: 8 bytes of head (u8 kind, u8 0, u16 credits, u32 0), then, of Data, the
// stream's bytes. Data costs its sender a credit; the receiver gives credits back as its reader has emptied buffers, a
// quarter of the window at once. So at most four messages of credits and one Bye are in the receiver's buffers beside a
// window of Data: what control messages need is set aside, and nobody ever finds no buffer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "common/little_endian.hpp"

namespace mural::fabric {

inline constexpr size_t kHeadBytes = 8;
inline constexpr size_t kMessageBytes = size_t{64} << 10; // with its head; a buffer of either end
inline constexpr uint16_t kWindow = 16;                   // messages of Data that a reader has not read
inline constexpr uint16_t kCreditsAtOnce = kWindow / 4;
inline constexpr size_t kControls = 6;
inline constexpr size_t kReceives = kWindow + kControls;
inline constexpr size_t kSends = kWindow + 1; // one is filled while a window is under way

enum class MessageKind : uint8_t { Data = 1, Credit = 2, Bye = 3 };

using Head = std::array<std::byte, kHeadBytes>;

inline Head makeHead(MessageKind kind, uint16_t credits = 0) {
    Head head{};
    head[0] = static_cast<std::byte>(kind);
    storeLittle<uint16_t>(head.data() + 2, credits);
    return head;
}

// Goes with the request to connect and with its answer: what the other end may send.
struct Greeting {
    uint32_t messageBytes = kMessageBytes;
    uint16_t window = kWindow;
};

inline constexpr size_t kGreetingBytes = 16;
inline constexpr char kGreetingMagic[] = "MURALFB\1"; // the last: version

inline std::array<std::byte, kGreetingBytes> makeGreeting() {
    std::array<std::byte, kGreetingBytes> bytes{};
    std::memcpy(bytes.data(), kGreetingMagic, 8);
    storeLittle<uint32_t>(bytes.data() + 8, kMessageBytes);
    storeLittle<uint16_t>(bytes.data() + 12, kWindow);
    return bytes;
}

// Nothing: it is none of Mural's, of another version, or one that nothing can be sent to. Providers may add zeros at the end.
inline std::optional<Greeting> readGreeting(std::span<const std::byte> bytes) {
    if (bytes.size() < kGreetingBytes || std::memcmp(bytes.data(), kGreetingMagic, 8) != 0) return {};
    const Greeting greeting{loadLittle<uint32_t>(bytes.data() + 8), loadLittle<uint16_t>(bytes.data() + 12)};
    if (greeting.messageBytes <= kHeadBytes || greeting.window == 0) return {};
    return greeting;
}

} // namespace mural::fabric
