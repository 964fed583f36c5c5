// One entry of a recording: a packet of a program's stream, or that a program has come or gone.
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "recording/format.hpp"

namespace mural::recording {

struct Entry {
    uint32_t stream = 0; // 0: an event
    uint64_t timeNs = 0;
    std::span<const std::byte> payload;
};

struct ClientEvent {
    Event kind = Event::ClientGone;
    uint32_t client = 0;
    int32_t pid = 0;  // ClientCame
    std::string name; // the same
};

// Appends the entry to what will be a block.
void appendEntry(std::vector<std::byte>& raw, const Entry& entry);
std::vector<std::byte> eventBytes(const ClientEvent& event);
// False: it is none that this version knows.
bool parseEvent(std::span<const std::byte> payload, ClientEvent& event);

// The entries of a block.
class EntryWalk {
public:
    explicit EntryWalk(std::span<const std::byte> raw) : raw_(raw) {}
    // False at the end, and where an entry is not one: malformed() then.
    bool next(Entry& entry);
    [[nodiscard]] bool malformed() const { return malformed_; }

private:
    std::span<const std::byte> raw_;
    size_t at_ = 0;
    bool malformed_ = false;
};

} // namespace mural::recording
