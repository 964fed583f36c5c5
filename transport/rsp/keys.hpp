// Keys of a session. From one secret of 32 random bytes, which members get over their encrypted control connection, each
// member's own key is derived; so no two members ever use one key with the same counter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "transport/rsp/datagram.hpp"

namespace mural::rsp {

constexpr size_t kKeyBytes = 32;
using Key = std::array<std::byte, kKeyBytes>;

// How datagrams are sealed.
enum class Seal : uint8_t {
    None = 0,   // for measuring
    Tag = 1,    // SipHash-2-4, 64 bits: who has no key can't change or add anything, but can read
    AesGcm = 2, // AES-256-GCM, where the processor has instructions for it
    ChaCha = 3, // ChaCha20-Poly1305
};
constexpr size_t kMostTagBytes = 16;
[[nodiscard]] constexpr size_t tagBytes(Seal seal) { return seal == Seal::None ? 0 : seal == Seal::Tag ? 8 : 16; }
[[nodiscard]] const char* nameOf(Seal seal);
// The fastest that hides what is sent, on this machine.
[[nodiscard]] Seal bestEncryption();
[[nodiscard]] bool available(Seal seal);

struct SessionKeys {
    uint64_t session = 0; // random: tells sessions on one group and port apart
    Seal seal = Seal::None;
    Key secret{};
};
// New ones from the system's random numbers.
[[nodiscard]] SessionKeys makeSessionKeys(Seal seal);
[[nodiscard]] Key memberKey(const SessionKeys& keys, MemberId member);

} // namespace mural::rsp
