#include "transport/discovery/announcement.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "common/base/little_endian.hpp"

namespace mural {

namespace {

constexpr std::string_view kMagic = "MURALDB";
constexpr std::byte kVersion{1};
constexpr size_t kHeadBytes = 28;

void append(std::vector<std::byte>& bytes, const std::string& text) {
    const size_t count = std::min(text.size(), kMaxAnnouncedText);
    bytes.push_back(static_cast<std::byte>(count));
    const auto* at = reinterpret_cast<const std::byte*>(text.data());
    bytes.insert(bytes.end(), at, at + count);
}

bool take(std::span<const std::byte>& left, std::string& into) {
    if (left.empty()) return false;
    const auto count = std::to_integer<size_t>(left.front());
    if (count > kMaxAnnouncedText || left.size() < 1 + count) return false;
    into.assign(reinterpret_cast<const char*>(left.data()) + 1, count);
    left = left.subspan(1 + count);
    // Printable only, because the texts are shown on terminals.
    return std::ranges::all_of(into, [](char c) { return c >= ' ' && c <= '~'; });
}

} // namespace

std::vector<std::byte> encode(const Announcement& a) {
    std::vector<std::byte> bytes(kHeadBytes);
    std::memcpy(bytes.data(), kMagic.data(), kMagic.size());
    bytes[7] = kVersion;
    bytes[8] = static_cast<std::byte>(a.kind);
    storeLittle(bytes.data() + 10, a.port);
    std::ranges::copy(a.uuid, bytes.begin() + 12);
    append(bytes, a.name);
    append(bytes, a.version);
    return bytes;
}

std::optional<Announcement> decodeAnnouncement(std::span<const std::byte> bytes) {
    if (bytes.size() < kHeadBytes || bytes.size() > kMaxAnnouncementBytes) return {};
    if (std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0 || bytes[7] != kVersion ||
        bytes[9] != std::byte{0})
        return {};
    Announcement a;
    a.kind = static_cast<AnnouncementKind>(bytes[8]);
    if (a.kind < AnnouncementKind::Here || a.kind > AnnouncementKind::Gone) return {};
    a.port = loadLittle<uint16_t>(bytes.data() + 10);
    std::copy_n(bytes.begin() + 12, a.uuid.size(), a.uuid.begin());
    auto left = bytes.subspan(kHeadBytes);
    if (!take(left, a.name) || !take(left, a.version) || !left.empty()) return {};
    if (a.kind == AnnouncementKind::Here && a.port == 0) return {};
    return a;
}

} // namespace mural
