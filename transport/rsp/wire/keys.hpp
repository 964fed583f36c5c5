// Session keys. Each member's key is derived from a secret of 32 random bytes, which members receive over their
// encrypted control connection. No two members use one key with the same counter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "transport/rsp/wire/datagram.hpp"

namespace mural::rsp {

constexpr size_t kKeyBytes = 32;
using Key = std::array<std::byte, kKeyBytes>;

// Protection of datagrams.
enum class Seal : uint8_t {
    None = 0,   // for measurements
    Tag = 1,    // SipHash-2-4, 64 bits: authentication without encryption
    AesGcm = 2, // AES-256-GCM, if the processor has instructions for it
    ChaCha = 3, // ChaCha20-Poly1305
};
constexpr size_t kMaxTagBytes = 16;
[[nodiscard]] constexpr size_t tagBytes(Seal seal) { return seal == Seal::None ? 0 : seal == Seal::Tag ? 8 : 16; }
[[nodiscard]] const char* nameOf(Seal seal);
// Returns the fastest encryption on this machine.
[[nodiscard]] Seal bestEncryption();
[[nodiscard]] bool available(Seal seal);

struct SessionKeys {
    uint64_t session = 0; // random; distinguishes sessions on one group and port
    Seal seal = Seal::None;
    Key secret{};
};
// Creates keys from the system's random generator.
[[nodiscard]] SessionKeys makeSessionKeys(Seal seal);
[[nodiscard]] Key memberKey(const SessionKeys& keys, MemberId member);

} // namespace mural::rsp
