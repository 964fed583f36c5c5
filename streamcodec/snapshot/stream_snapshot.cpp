#include "streamcodec/snapshot/stream_snapshot.hpp"

#include <cstring>

#include "common/log/log.hpp"
#include "streamcodec/snapshot/packet_splitter.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::snapshot {

void hideFrames(std::span<std::byte> records) {
    RecordWalk walk(records);
    RecordView r;
    while (walk.next(r)) {
        if ((r.opcode != wire::kOpSwap && r.opcode != wire::kOpFrontPicture) || r.arguments.size() < 8) continue;
        const uint32_t unseen = wire::kUnseenFrame;
        std::memcpy(records.data() + r.offset + r.sizeBytes - r.arguments.size() + 4, &unseen, sizeof unseen);
    }
}

void StreamSnapshot::append(uint32_t stream, std::span<const std::byte> payload) {
    if (overrun_ || wire::clientOf(stream) == 0) return;
    log_.append(stream, payload);
    // At the limit, sweep once more and require a quarter of it to become free; otherwise every packet would cause a
    // sweep.
    if (log_.compactIfGrown() || log_.sizeBytes() <= boundBytes_) return;
    log_.compact();
    if (log_.sizeBytes() <= boundBytes_ / 2 + boundBytes_ / 4) return;
    overrun_ = true;
    const size_t logBytes = log_.sizeBytes();
    log_.clear();
    // Only a diagnostic: the session reports a lost node to the user.
    log::debug(log::Topic::Node, "the snapshot for late nodes has grown to ", logBytes >> 20,
               " MiB: no node can join from now on; use a larger --cache-size");
}

void StreamSnapshot::clientGone(uint32_t client) {
    if (!overrun_) log_.clientGone(client);
}

std::vector<SnapshotPacket> StreamSnapshot::snapshot() {
    std::vector<SnapshotPacket> packets;
    if (overrun_) return packets;
    log_.compact();
    PacketSplitter splitter([&](uint32_t stream, std::span<const std::byte> payload) {
        packets.push_back({stream, {payload.begin(), payload.end()}});
        hideFrames(packets.back().payload);
    });
    log_.forEach([&](uint32_t stream, std::span<const std::byte> records) { splitter.add(stream, records); });
    splitter.flush();
    return packets;
}

} // namespace mural::snapshot
