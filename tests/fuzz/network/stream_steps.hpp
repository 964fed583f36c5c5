// The steps of an input of stream_fuzz: a byte each, followed by their arguments.
#pragma once

#include <cstdint>

namespace mural::fuzz {

enum class StreamStep : uint8_t {
    Wait,     // u32 µs
    ToReader, // piece: an arbitrary datagram
    ToWriter, // piece
    Write,    // u16 bytes
    Flush,
    Read,         // u16 bytes
    PassOn,       // u16 position, u8 bits: the writer's next datagram arrives, changed at the position
    Answer,       // u16 position, u8 bits: the same for the reader's next datagram
    Lose,         // drops the writer's next datagram
    AddMember,    // u8
    RemoveMember, // u8
    Count
};

} // namespace mural::fuzz
