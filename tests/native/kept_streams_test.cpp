// The state of native programs that the head keeps for restarted nodes.
#include "nodes/head/membership/kept_streams.hpp"

#include <cstring>
#include <gtest/gtest.h>
#include <mural/shared.hpp>

#include "common/base/clock.hpp"
#include "native/runtime/client_objects.hpp"
#include "native/session/packet_writer.hpp"
#include "objects/ends/object_writer.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/record_walk.hpp"

namespace mural {
namespace {

constexpr uint32_t kStream = wire::streamOf(1, 0);
constexpr size_t kMuch = size_t{64} << 20;

struct State {
    double angle = 0;
    std::string text;
    Blob blob;
    template <class Visit> void fields(Visit& visit) { visit(angle, text, blob); }
};

// An application that writes into a kept stream.
class Application final : public objects::MessageSink {
public:
    explicit Application(snapshot::KeptStream& kept)
        : packets_([&kept](std::span<const std::byte> packet) {
              kept.append(kStream, packet);
              return Result<void>();
          }),
          writer_(*this, {.keepsPushed = false}) {}
    ~Application() override { writer_.close(); }

    void toAll(std::span<const std::byte> message) override { send(message); }
    void toOne(objects::PeerId, std::span<const std::byte>) override {} // not kept
    objects::ObjectWriter& writer() { return writer_; }

    void frame(uint32_t number) {
        wire::NativeFrame frame{};
        frame.number = number;
        const uint32_t swap[2] = {1, number};
        packets_.add(wire::kOpFrame, std::as_bytes(std::span(&frame, 1)));
        packets_.add(wire::kOpSwap, std::as_bytes(std::span(swap)));
        EXPECT_TRUE(packets_.flush().ok());
        writer_.frame(number);
    }

private:
    void send(std::span<const std::byte> message) {
        wire::splitIntoRecords(message, [this](std::span<const std::byte> record) { packets_.add(record); });
        EXPECT_TRUE(packets_.sendComplete().ok());
    }

    native::PacketWriter packets_;
    objects::ObjectWriter writer_;
};

// A node that receives a snapshot.
struct Node {
    native::ClientObjects objects{[](std::span<const std::byte>) {}, {}};
    uint64_t frame = 0;
    int swaps = 0;

    explicit Node(const std::vector<snapshot::SnapshotPacket>& packets) {
        for (const auto& packet : packets) {
            EXPECT_EQ(packet.stream, kStream);
            wire::RecordWalk walk(packet.payload);
            wire::RecordView r;
            while (walk.next(r)) {
                if (r.opcode == wire::kOpObject) {
                    EXPECT_TRUE(objects.input(wire::kToAllNodes, r.arguments).ok());
                } else if (r.opcode == wire::kOpFrame) {
                    std::memcpy(&frame, r.arguments.data(), sizeof frame);
                    objects.frame(frame);
                } else if (r.opcode == wire::kOpSwap) {
                    ++swaps;
                }
            }
            EXPECT_TRUE(walk.whole());
        }
    }
    std::shared_ptr<const State> state() {
        auto found = objects.reader().stateAt<State>(frame, "scene", Deadline::inMs(0));
        return found ? *found : nullptr;
    }
};

TEST(NativeStream, bringsANodeToTheNewestState) {
    const auto kept = makeNativeStream(kMuch);
    Application application(*kept);
    ShareOptions options;
    options.name = "scene";
    auto object = application.writer().share(State{}, options);
    ASSERT_TRUE(object.ok());
    Shared<State> scene = std::move(object.value());
    const std::vector<std::byte> large(size_t{3} << 20, std::byte{7});
    for (uint32_t frame = 1; frame <= 5; ++frame) {
        scene.edit().angle = frame;
        if (frame == 2) scene.edit().text = "from the second frame on";
        if (frame == 3) scene.edit().blob = *Blob::copyOf(large);
        ASSERT_TRUE(scene.commit().ok());
        application.frame(frame);
    }
    Node node(kept->snapshot());
    EXPECT_EQ(node.frame, 5u);
    EXPECT_EQ(node.swaps, 0); // no frame of a snapshot is shown
    const auto state = node.state();
    ASSERT_NE(state, nullptr);
    EXPECT_EQ(state->angle, 5);
    EXPECT_EQ(state->text, "from the second frame on");
    EXPECT_EQ(state->blob.bytes().size(), large.size());
}

// A snapshot between two packets of one message: the node receives the rest of the message as a member.
TEST(NativeStream, keepsTheBeginningOfAMessage) {
    const auto kept = makeNativeStream(kMuch);
    std::vector<std::vector<std::byte>> later; // packets after the snapshot
    std::vector<snapshot::SnapshotPacket> packets;
    native::PacketWriter writer([&](std::span<const std::byte> packet) {
        if (packets.empty()) {
            kept->append(kStream, packet);
            packets = kept->snapshot();
        } else {
            later.emplace_back(packet.begin(), packet.end());
        }
        return Result<void>();
    });
    struct Sink final : objects::MessageSink {
        native::PacketWriter* writer = nullptr;
        void toAll(std::span<const std::byte> message) override {
            wire::splitIntoRecords(message, [this](std::span<const std::byte> record) { writer->add(record); });
        }
        void toOne(objects::PeerId, std::span<const std::byte>) override {}
    } sink;
    sink.writer = &writer;
    objects::ObjectWriter objects(sink, {.keepsPushed = false});
    ShareOptions options;
    options.name = "scene";
    auto object = objects.share(State{}, options);
    ASSERT_TRUE(object.ok());
    Shared<State> scene = std::move(object.value());
    scene.edit().text = std::string(900'000, 'x');
    ASSERT_TRUE(scene.commit().ok());
    wire::NativeFrame frame{};
    frame.number = 1;
    writer.add(wire::kOpFrame, std::as_bytes(std::span(&frame, 1)));
    ASSERT_TRUE(writer.flush().ok());
    ASSERT_GT(later.size(), 1u);
    for (auto& packet : later) packets.push_back({kStream, packet});
    Node node(packets);
    const auto state = node.state();
    ASSERT_NE(state, nullptr);
    EXPECT_EQ(state->text.size(), 900'000u);
    objects.close();
}

TEST(NativeStream, forgetsEndedPrograms) {
    const auto kept = makeNativeStream(kMuch);
    Application application(*kept);
    auto object = application.writer().share(State{});
    ASSERT_TRUE(object.ok());
    ASSERT_TRUE(object.value().commit().ok());
    application.frame(1);
    EXPECT_FALSE(kept->snapshot().empty());
    kept->clientGone(1);
    EXPECT_TRUE(kept->snapshot().empty());
    EXPECT_EQ(kept->sizeBytes(), 0u);
}

TEST(NativeStream, servesUpToItsLimit) {
    const auto kept = makeNativeStream(1 << 20);
    Application application(*kept);
    auto object = application.writer().share(State{});
    ASSERT_TRUE(object.ok());
    Shared<State> scene = std::move(object.value());
    ASSERT_TRUE(scene.commit().ok());
    application.frame(1);
    EXPECT_TRUE(kept->serves());
    scene.edit().text = std::string(2 << 20, 'x');
    ASSERT_TRUE(scene.commit().ok());
    application.frame(2);
    EXPECT_FALSE(kept->serves());
}

} // namespace
} // namespace mural
