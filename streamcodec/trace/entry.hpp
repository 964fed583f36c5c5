// One entry of a trace: a packet of a program's stream, or the start or end of a program.
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "streamcodec/trace/format.hpp"

namespace mural::trace {

struct Entry {
    uint32_t stream = 0; // 0: an event
    uint64_t timeNs = 0;
    std::span<const std::byte> payload;
};

struct ClientEvent {
    Event kind = Event::ClientGone;
    uint32_t client = 0;
    int32_t pid = 0;  // for ClientCame
    std::string name; // for ClientCame
};

// Appends the entry to the contents of a block.
void appendEntry(std::vector<std::byte>& raw, const Entry& entry);
std::vector<std::byte> eventBytes(const ClientEvent& event);
// Returns false for an unknown event.
bool parseEvent(std::span<const std::byte> payload, ClientEvent& event);

// Iterates over the entries of a block.
class EntryWalk {
public:
    explicit EntryWalk(std::span<const std::byte> raw) : raw_(raw) {}
    // Returns false at the end, and for a malformed entry; malformed() distinguishes them.
    bool next(Entry& entry);
    [[nodiscard]] bool malformed() const { return malformed_; }

private:
    std::span<const std::byte> raw_;
    size_t at_ = 0;
    bool malformed_ = false;
};

} // namespace mural::trace
