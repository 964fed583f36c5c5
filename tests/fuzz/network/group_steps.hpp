// The steps of an input of group_fuzz: a byte each, followed by their arguments. The suffixes "at the host" and "at the
// member" name the end that is affected.
#pragma once

#include <cstdint>

namespace mural::fuzz {

enum class GroupStep : uint8_t {
    Wait,            // u32 µs
    Connect,         // a control connection to the host opens
    Disconnect,      // u8 id
    ControlToHost,   // u8 id, piece: an arbitrary message
    ControlToMember, // piece
    PassToHost,      // u16 position, u8 bits: the member's next message arrives, changed at the position
    PassToMember,    // the same in the other direction
    DatagramToHost,  // piece
    DatagramToMember,
    PassDatagramToHost, // u16 position, u8 bits
    PassDatagramToMember,
    WriteAtHost, // u16 bytes
    WriteAtMember,
    ReadAll,
    Count
};

} // namespace mural::fuzz
