#include "streamcodec/trace/entry.hpp"

#include <algorithm>

#include "streamcodec/wire/packet.hpp"

namespace mural::trace {
namespace {

constexpr size_t kEventHeadBytes = 12; // kind, client, pid

} // namespace

void appendEntry(std::vector<std::byte>& raw, const Entry& entry) {
    const EntryHeader header{static_cast<uint32_t>(entry.payload.size()), entry.stream, entry.timeNs};
    const size_t at = raw.size();
    raw.resize(at + entryBytes(entry.payload.size()));
    std::memcpy(raw.data() + at, &header, sizeof header);
    if (!entry.payload.empty())
        std::memcpy(raw.data() + at + sizeof header, entry.payload.data(), entry.payload.size());
}

std::vector<std::byte> eventBytes(const ClientEvent& event) {
    const size_t nameBytes = event.kind == Event::ClientCame ? (event.name.size() + 3) / 4 * 4 : 0;
    std::vector<std::byte> bytes(kEventHeadBytes + nameBytes);
    const uint32_t head[3] = {static_cast<uint32_t>(event.kind), event.client, static_cast<uint32_t>(event.pid)};
    std::memcpy(bytes.data(), head, sizeof head);
    if (nameBytes > 0) std::memcpy(bytes.data() + kEventHeadBytes, event.name.data(), event.name.size());
    return bytes;
}

bool parseEvent(std::span<const std::byte> payload, ClientEvent& event) {
    if (payload.size() < kEventHeadBytes) return false;
    uint32_t head[3];
    std::memcpy(head, payload.data(), sizeof head);
    event.kind = static_cast<Event>(head[0]);
    event.client = head[1];
    event.pid = static_cast<int32_t>(head[2]);
    const auto name = payload.subspan(kEventHeadBytes);
    event.name.assign(reinterpret_cast<const char*>(name.data()), name.size());
    event.name.resize(std::min(event.name.size(), event.name.find('\0')));
    return (event.kind == Event::ClientCame || event.kind == Event::ClientGone) && event.client >= 1 &&
           event.client <= 0xffff;
}

bool EntryWalk::next(Entry& entry) {
    const size_t left = raw_.size() - at_;
    if (left == 0 || malformed_) return false;
    EntryHeader header{};
    if (left >= sizeof header) std::memcpy(&header, raw_.data() + at_, sizeof header);
    malformed_ = left < sizeof header || header.sizeBytes > wire::kMaxPacketBytes ||
                 entryBytes(header.sizeBytes) > left || (header.stream != 0 && wire::clientOf(header.stream) == 0);
    if (malformed_) return false;
    entry.stream = header.stream;
    entry.timeNs = header.timeNs;
    entry.payload = raw_.subspan(at_ + sizeof header, header.sizeBytes);
    at_ += entryBytes(header.sizeBytes);
    return true;
}

} // namespace mural::trace
