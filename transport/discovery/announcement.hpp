// What nodes say to all who listen, in one datagram: that they wait, where, and as whom. Nothing in it is secret, and
// nothing of it is trusted: who answers there still has to show that it knows the secret. Little endian:
//
//   0 "MURALDB"   7 u8 version   8 u8 kind   9 u8 0   10 u16 port   12 UUID
//   28 u8 length, name   then u8 length, version of the program
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "transport/uuid.hpp"

namespace mural {

enum class AnnouncementKind : uint8_t {
    Here = 1,  // a node waits
    Asked = 2, // somebody looks for nodes; the rest means nothing
    Gone = 3,  // it waits no longer
};

struct Announcement {
    AnnouncementKind kind = AnnouncementKind::Here;
    uint16_t port = 0; // TCP
    Uuid uuid{};
    std::string name;    // of the machine
    std::string version; // of Mural
};

constexpr size_t kMostAnnouncedText = 63;
constexpr size_t kMostAnnouncementBytes = 28 + 2 * (1 + kMostAnnouncedText);

// Texts that are too long are cut.
std::vector<std::byte> encode(const Announcement& a);
// Nothing for another version, for what is not whole or out of bounds, and for texts that are not printable ASCII.
std::optional<Announcement> decodeAnnouncement(std::span<const std::byte> bytes);

} // namespace mural
