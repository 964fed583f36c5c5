// Collects records into packets of the stream to the head.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "common/base/result.hpp"

namespace mural::native {

class PacketWriter {
public:
    // Sends a packet of at most capture::kChunkBytes. May block; errors end the write.
    using Send = std::function<Result<void>(std::span<const std::byte> packet)>;
    explicit PacketWriter(Send send) : send_(std::move(send)) {}

    // Appends a record of at most capture::kChunkBytes. Sends the packet before it if both do not fit into one. An
    // error drops the packet.
    Result<void> add(std::span<const std::byte> record);
    // Appends a record with this opcode and these arguments, whose size is a multiple of 4.
    Result<void> add(uint16_t opcode, std::span<const std::byte> arguments);
    // Sends what was collected.
    Result<void> flush();

private:
    Send send_;
    std::vector<std::byte> packet_;
};

} // namespace mural::native
