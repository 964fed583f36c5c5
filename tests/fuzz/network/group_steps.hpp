// The steps that an input of group_fuzz is made of: a byte each, and what they need behind it. "At the host" and "at
// the member" stand for whom it happens to.
#pragma once

#include <cstdint>

namespace mural::fuzz {

enum class GroupStep : uint8_t {
    Wait,           // u32 µs
    Connect,        // a control connection to the host is open
    Disconnect,     // u8 id
    ControlToHost,  // u8 id, piece: a message, whatever it holds
    ControlToMember, // piece
    PassToHost,     // u16 place, u8 bits: the member's next message arrives, changed there
    PassToMember,   // the same the other way
    DatagramToHost, // piece
    DatagramToMember,
    PassDatagramToHost, // u16 place, u8 bits
    PassDatagramToMember,
    WriteAtHost,    // u16 bytes
    WriteAtMember,
    ReadAll,
    Count
};

} // namespace mural::fuzz
