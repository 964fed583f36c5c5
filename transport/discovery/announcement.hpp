// The announcement of a daemon, as one datagram. It contains no secrets and is not trusted: a node still has to
// prove that it knows the session's secret. Little-endian:
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
    Here = 1,   // a node waits
    Search = 2, // a search for nodes; other fields are ignored
    Gone = 3,   // the node no longer waits
};

struct Announcement {
    AnnouncementKind kind = AnnouncementKind::Here;
    uint16_t port = 0; // TCP port
    Uuid uuid{};
    std::string name;    // host name
    std::string version; // Mural's version
};

constexpr size_t kMaxAnnouncedText = 63;
constexpr size_t kMaxAnnouncementBytes = 28 + 2 * (1 + kMaxAnnouncedText);

// Encodes; truncates long texts.
std::vector<std::byte> encode(const Announcement& a);
// Decodes. Rejects other versions, truncated or invalid data, and texts that are not printable ASCII.
std::optional<Announcement> decodeAnnouncement(std::span<const std::byte> bytes);

} // namespace mural
