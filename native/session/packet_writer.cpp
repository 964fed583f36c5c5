#include "native/session/packet_writer.hpp"

#include <cstring>
#include <utility>

#include "common/ipc/capture_ring.hpp"

namespace mural::native {

void PacketWriter::complete() {
    if (packet_.empty()) return;
    waitingBytes_ += packet_.size();
    waiting_.push_back(std::exchange(packet_, {}));
}

void PacketWriter::add(std::span<const std::byte> record) {
    if (packet_.size() + record.size() > capture::kChunkBytes) complete();
    packet_.insert(packet_.end(), record.begin(), record.end());
}

void PacketWriter::add(uint16_t opcode, std::span<const std::byte> arguments) {
    std::vector<std::byte> record(sizeof(uint32_t) + arguments.size());
    const uint32_t header = opcode | static_cast<uint32_t>(record.size() / 4) << 16;
    std::memcpy(record.data(), &header, sizeof header);
    std::memcpy(record.data() + sizeof header, arguments.data(), arguments.size());
    add(record);
}

Result<void> PacketWriter::sendComplete() {
    for (; !waiting_.empty(); waiting_.pop_front()) {
        if (auto sent = send_(waiting_.front()); !sent) return sent;
        waitingBytes_ -= waiting_.front().size();
    }
    return {};
}

Result<void> PacketWriter::flush() {
    complete();
    return sendComplete();
}

} // namespace mural::native
