// Encodes a command of the head (wire::HeadCommand) as the payload of a packet.
#pragma once

#include <cstring>
#include <span>
#include <vector>

#include "common/base/copy_bytes.hpp"
#include "streamcodec/wire/head_messages.hpp"

namespace mural {

inline std::vector<std::byte> commandBytes(wire::HeadCommand command, std::span<const std::byte> arguments) {
    const auto word = static_cast<uint32_t>(command);
    std::vector<std::byte> payload(sizeof(word) + arguments.size());
    std::memcpy(payload.data(), &word, sizeof(word));
    copyBytes(arguments, std::span(payload).subspan(sizeof(word)));
    return payload;
}

} // namespace mural
