// The steps that an input of stream_fuzz is made of: a byte each, and what they need behind it.
#pragma once

#include <cstdint>

namespace mural::fuzz {

enum class StreamStep : uint8_t {
    Wait,         // u32 µs
    ToReader,     // piece: a datagram, whatever it holds
    ToWriter,     // piece
    Write,        // u16 bytes
    Flush,
    Read,         // u16 bytes
    PassOn,       // u16 place, u8 bits: the writer's next datagram arrives, changed there
    Answer,       // u16 place, u8 bits: the reader's next one
    Lose,         // the writer's next one
    AddMember,    // u8
    RemoveMember, // u8
    Count
};

} // namespace mural::fuzz
