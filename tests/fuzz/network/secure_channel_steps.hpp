// The steps of an input of secure_channel_fuzz. The upper bit of the byte selects the end: host if set, otherwise
// member.
#pragma once

#include <cstdint>

namespace mural::fuzz {

enum class ChannelStep : uint8_t {
    Pass, // u16 count, u16 position, u8 bits: `count` bytes that it sent arrive, changed at the position
    Add,  // piece: arrives in the name of this end
    Send, // piece: a message
    Finish,
    Count
};

} // namespace mural::fuzz
