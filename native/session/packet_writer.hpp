// Collects records into packets of the stream to the head.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "common/base/result.hpp"

namespace mural::native {

// Never drops a record: packets that could not be sent are sent with the next call, in order.
class PacketWriter {
public:
    // Sends a packet of at most capture::kChunkBytes, or returns an error and has sent nothing. May block.
    using Send = std::function<Result<void>(std::span<const std::byte> packet)>;
    explicit PacketWriter(Send send) : send_(std::move(send)) {}

    // Appends a record of at most capture::kChunkBytes.
    void add(std::span<const std::byte> record);
    // Appends a record with this opcode and these arguments, whose size is a multiple of 4.
    void add(uint16_t opcode, std::span<const std::byte> arguments);
    // Sends packets that are complete. An error leaves the rest for later.
    Result<void> sendComplete();
    // Sends everything. An error leaves the rest for later.
    Result<void> flush();

    // Size of the complete packets that wait.
    [[nodiscard]] size_t waitingBytes() const { return waitingBytes_; }

private:
    void complete();

    Send send_;
    std::deque<std::vector<std::byte>> waiting_;
    size_t waitingBytes_ = 0;
    std::vector<std::byte> packet_;
};

} // namespace mural::native
