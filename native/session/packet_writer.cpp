#include "native/session/packet_writer.hpp"

#include <cstring>

#include "common/ipc/capture_ring.hpp"

namespace mural::native {

Result<void> PacketWriter::add(std::span<const std::byte> record) {
    if (packet_.size() + record.size() > capture::kChunkBytes)
        if (auto sent = flush(); !sent) return sent;
    packet_.insert(packet_.end(), record.begin(), record.end());
    return {};
}

Result<void> PacketWriter::add(uint16_t opcode, std::span<const std::byte> arguments) {
    std::vector<std::byte> record(sizeof(uint32_t) + arguments.size());
    const uint32_t header = opcode | static_cast<uint32_t>(record.size() / 4) << 16;
    std::memcpy(record.data(), &header, sizeof header);
    std::memcpy(record.data() + sizeof header, arguments.data(), arguments.size());
    return add(record);
}

Result<void> PacketWriter::flush() {
    if (packet_.empty()) return {};
    auto sent = send_(packet_);
    packet_.clear();
    return sent;
}

} // namespace mural::native
