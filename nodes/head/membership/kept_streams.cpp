#include "nodes/head/membership/kept_streams.hpp"

#include <map>

#include "common/log/log.hpp"
#include "objects/core/object_keeper.hpp"
#include "streamcodec/snapshot/packet_splitter.hpp"
#include "streamcodec/snapshot/stream_snapshot.hpp"
#include "streamcodec/wire/object_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/record_walk.hpp"

namespace mural {

namespace {

// Blobs that the keeper could not map are requested by the nodes that need them.
class NoRequests final : public objects::MessageSink {
public:
    void toAll(std::span<const std::byte>) override {}
    void toOne(objects::PeerId, std::span<const std::byte>) override {}
};

class NativeStream final : public snapshot::KeptStream {
public:
    NativeStream(size_t maxBytes, bool isOneMachine)
        : maxBytes_(maxBytes), transfer_(isOneMachine ? objects::BlobTransfer::Place : objects::BlobTransfer::Bytes) {}

    void append(uint32_t stream, std::span<const std::byte> payload) override {
        const uint32_t clientId = wire::clientOf(stream);
        if (clientId == 0) return;
        Client& client = clients_[clientId];
        client.stream = stream;
        wire::RecordWalk walk(payload);
        wire::RecordView r;
        while (walk.next(r)) {
            const auto record = payload.subspan(r.offset, r.sizeBytes);
            if (r.opcode == wire::kOpObject)
                client.take(record, r.arguments);
            else if (r.opcode == wire::kOpFrame)
                client.frame.assign(record.begin(), record.end());
            else if (r.opcode == wire::kOpWindow)
                client.windows[wire::argumentWord(r, 0)].assign(record.begin(), record.end());
        }
    }
    void clientGone(uint32_t client) override { clients_.erase(client); }
    [[nodiscard]] bool serves() const override { return sizeBytes() <= maxBytes_; }

    [[nodiscard]] std::vector<snapshot::SnapshotPacket> snapshot() override {
        std::vector<snapshot::SnapshotPacket> packets;
        snapshot::PacketSplitter splitter([&](uint32_t stream, std::span<const std::byte> payload) {
            packets.push_back({stream, {payload.begin(), payload.end()}});
        });
        for (auto& [id, client] : clients_) {
            const auto add = [&, stream = client.stream](std::span<const std::byte> records) {
                splitter.add(stream, records);
            };
            for (const auto& [window, record] : client.windows) add(record);
            client.keeper->writeCatalogue(
                transfer_, [&](std::span<const std::byte> message) { wire::splitIntoRecords(message, add); });
            if (!client.frame.empty()) add(client.frame);
            if (!client.open.empty()) add(client.open); // the rest follows
        }
        splitter.flush();
        return packets;
    }
    [[nodiscard]] size_t sizeBytes() const override {
        size_t sum = 0;
        for (const auto& [id, client] : clients_)
            sum += static_cast<size_t>(client.keeper->sizeBytes() + client.keeper->blobBytes());
        return sum;
    }

private:
    struct Client {
        uint32_t stream = 0;
        NoRequests sink;
        // By pointer, because the keeper refers to the sink.
        std::unique_ptr<objects::ObjectKeeper> keeper = std::make_unique<objects::ObjectKeeper>(sink);
        wire::ObjectRecordJoiner joiner;
        std::map<uint32_t, std::vector<std::byte>> windows; // the latest record of each
        std::vector<std::byte> frame;
        std::vector<std::byte> open; // records of the message in progress

        void take(std::span<const std::byte> record, std::span<const std::byte> arguments) {
            open.insert(open.end(), record.begin(), record.end());
            const bool isValid = joiner.add(arguments);
            if (!isValid || joiner.isComplete()) open.clear();
            if (!isValid || !joiner.isComplete()) return;
            if (auto merged = keeper->input(joiner.message(), 0); !merged)
                log::debug(log::Topic::Node, "rejoin log: ", merged.error().message);
        }
    };
    const size_t maxBytes_;
    const objects::BlobTransfer transfer_;
    std::map<uint32_t, Client> clients_;
};

} // namespace

std::unique_ptr<snapshot::KeptStream> makeCapturedStream(size_t maxBytes) {
    return std::make_unique<snapshot::StreamSnapshot>(maxBytes);
}

std::unique_ptr<snapshot::KeptStream> makeNativeStream(size_t maxBytes, bool isOneMachine) {
    return std::make_unique<NativeStream>(maxBytes, isOneMachine);
}

} // namespace mural
