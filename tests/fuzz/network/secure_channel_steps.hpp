// The steps that an input of secure_channel_fuzz is made of; the upper bit of their byte: the host's, else the member's.
#pragma once

#include <cstdint>

namespace mural::fuzz {

enum class ChannelStep : uint8_t {
    Pass,   // u16 count, u16 place, u8 bits: so much of what it has sent arrives, changed there
    Add,    // piece: arrives as if it had sent it
    Send,   // piece: a message
    Finish,
    Count
};

} // namespace mural::fuzz
