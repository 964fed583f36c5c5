// A render node without GL in a thread of the test. Answers the requests of FakeProgram's records, draws pictures whose
// pixels encode node and frame, and fails on demand.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "nodes/session/session_config.hpp"
#include "streamcodec/wire/frame_spans.hpp"
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/node_messages.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"
#include "tests/head/support/fake_program.hpp"
#include "transport/connection.hpp"

namespace mural {

struct FakeNodeBehaviour {
    bool pictures = false;
    bool silentStart = false;              // never ready
    bool refuses = false;                  // reports this reason instead of being ready, and ends
    bool drawsWhole = false;               // reported with every frame
    bool keepsAreas = false;               // reported with every frame
    uint64_t busyNs = 0;                   // reported with every frame
    std::string driverMessage;             // a driver event with every frame
    uint32_t dieAtFrame = 0;               // closes its connection instead of finishing this frame
    uint32_t dieAtRequest = 0;             // instead of answering
    uint32_t garbageAtFrame = 0;           // sends a malformed message
    bool overlappingSpans = false;         // of the statistics of its frames
    bool halfAnswer = false;               // sends the first part of an answer, then dies
    bool noBye = false;                    // hangs at the end
    bool alive = false;                    // sends heartbeats
    std::atomic<bool>* isPaused = nullptr; // reads nothing while true
};

class FakeNode {
public:
    struct Packet {
        uint32_t stream;
        std::vector<uint32_t> words;
    };

    FakeNode(std::unique_ptr<Connection> connection, FakeNodeBehaviour behaviour)
        : connection_(std::move(connection)), behaviour_(behaviour), thread_([this] { work(); }) {}
    ~FakeNode() {
        stop_ = true;
        waitEnd();
    }
    void waitEnd() {
        if (thread_.joinable()) thread_.join();
    }

    std::vector<Packet> packets() const {
        const std::lock_guard lock(mutex_);
        return packets_;
    }

private:
    static uint32_t op(const std::vector<uint32_t>& words) { return words.empty() ? 0 : words[0]; }

    void work() {
        while (!stop_) {
            if (behaviour_.isPaused != nullptr && *behaviour_.isPaused) {
                std::this_thread::yield();
                continue;
            }
            wire::PacketHeader header{};
            const auto got = connection_->read(std::as_writable_bytes(std::span(&header, 1)), Deadline::inMs(20));
            if (behaviour_.alive) sendParts({static_cast<uint32_t>(wire::NodeMessage::Alive), 0}, {}, {});
            if (!got && connection_->timedOut()) continue;
            if (!got) return;
            std::vector<uint32_t> words(header.sizeBytes / 4 + 1);
            const auto bytes = std::as_writable_bytes(std::span(words)).first(header.sizeBytes);
            if (!connection_->read(bytes, Deadline::inMs(kTestPatienceMs))) return;
            words.resize(header.sizeBytes / 4);
            // still requested
            while (behaviour_.isPaused != nullptr && *behaviour_.isPaused && !stop_) std::this_thread::yield();
            note(header.stream, words);
            const bool goOn = header.stream == 0 ? command(words, bytes) : records(header.stream, words);
            connection_->flush();
            if (!goOn) connection_->close();
            if (!goOn || goodbyeReceived_) return;
        }
    }

    void note(uint32_t stream, const std::vector<uint32_t>& words) {
        const std::lock_guard lock(mutex_);
        packets_.push_back({stream, words});
    }

    bool command(const std::vector<uint32_t>& words, std::span<const std::byte> bytes) {
        if (op(words) == static_cast<uint32_t>(wire::HeadCommand::Setup)) {
            const auto json = bytes.subspan(4);
            auto setup = nodeSetupFromJson({reinterpret_cast<const char*>(json.data()), json.size()});
            if (!setup) return false;
            if (behaviour_.refuses) {
                sendText(wire::NodeMessage::Log, "another build");
                return false;
            }
            setup_ = *setup;
            const std::string common = "GL_COMMON GL_ONLY_" + std::to_string(setup_.node);
            const std::string ready = R"({"host":"h","pid":)" + std::to_string(getpid()) +
                                      R"(,"renderer":"fake","glVersion":"4.)" + std::to_string(setup_.node) +
                                      R"( fake","extensions":")" + common + "\"}";
            if (!behaviour_.silentStart) sendText(wire::NodeMessage::Ready, ready);
        }
        if (op(words) == static_cast<uint32_t>(wire::HeadCommand::Statistics)) sendsSpans_ = words.at(1) != 0;
        if (op(words) == static_cast<uint32_t>(wire::HeadCommand::ViewportAssignment))
            areas_ = words.at(1); // applied at once
        if (op(words) == static_cast<uint32_t>(wire::HeadCommand::ClientGone))
            sendStruct(wire::NodeMessage::WindowGone, wire::WindowGoneMessage{words.at(1), wire::kAllWindows}, {});
        const bool leaves = op(words) == static_cast<uint32_t>(wire::HeadCommand::Leave) &&
                            words.at(1) == static_cast<uint32_t>(setup_.node);
        if ((leaves || op(words) == static_cast<uint32_t>(wire::HeadCommand::Finish)) && !behaviour_.noBye) {
            sendText(wire::NodeMessage::Goodbye, R"({"commands":42,"cpuSeconds":0.5})");
            goodbyeReceived_ = true;
        }
        return true;
    }

    bool records(uint32_t stream, const std::vector<uint32_t>& words) {
        const uint32_t client = wire::clientOf(stream);
        for (size_t at = 0; at + 2 <= words.size() && words[at] >= 2 && at + words[at] <= words.size();
             at += words[at]) {
            const std::vector<uint32_t> a(words.begin() + static_cast<long>(at) + 2,
                                          words.begin() + static_cast<long>(at) + words[at]);
            if (words[at + 1] == kFakeSwap && !swap(client, a)) return false;
            if (words[at + 1] == kFakeWindowGone)
                sendStruct(wire::NodeMessage::WindowGone, wire::WindowGoneMessage{client, a[0]}, {});
            const bool isRead = words[at + 1] >= kFakePixels && words[at + 1] <= kFakeSum;
            if (isRead && !answer(client, words[at + 1], a)) return false;
        }
        return true;
    }

    // The columns of the window that this node draws.
    PixelViewport region(int32_t w, int32_t h) const {
        return regionViewport({setup_.columns, setup_.rows, 1},
                              {setup_.regionColumn, setup_.regionRow, setup_.regionColumns, setup_.regionRows}, w, h);
    }

    bool swap(uint32_t client, const std::vector<uint32_t>& a) {
        const uint32_t frame = a[0];
        if (frame == behaviour_.dieAtFrame) return false;
        if (frame == behaviour_.garbageAtFrame) {
            const wire::MessageHeader bad{99, 0xffffffff};
            return sendParts(bad, {}, {});
        }
        if (behaviour_.pictures) {
            const PixelViewport v = region(static_cast<int32_t>(a[2]), static_cast<int32_t>(a[3]));
            const wire::PictureHeader header{client, a[1], frame, v.x, v.y, v.w, v.h, a[2], a[3], a[1], 0, 0};
            const uint32_t pixel = frame << 8 | static_cast<uint32_t>(setup_.node);
            const std::vector<uint32_t> rows(static_cast<size_t>(v.area()), pixel);
            sendStruct(wire::NodeMessage::Picture, header, std::as_bytes(std::span(rows)));
        }
        if (!behaviour_.driverMessage.empty()) {
            const wire::DriverEvent event{client,
                                          7,
                                          static_cast<uint32_t>(wire::DriverEventKind::DebugMessage),
                                          1,
                                          2,
                                          static_cast<uint32_t>(setup_.node),
                                          4,
                                          static_cast<uint32_t>(behaviour_.driverMessage.size())};
            sendStruct(wire::NodeMessage::DriverEvent, event, std::as_bytes(std::span(behaviour_.driverMessage)));
        }
        if (sendsSpans_) sendSpans(client, a[1], frame);
        wire::FrameDoneMessage done{};
        done.client = client;
        done.window = a[1];
        done.frame = frame;
        done.width = a[2];
        done.height = a[3];
        done.calls = 7 * frame;
        done.flags = (behaviour_.drawsWhole ? wire::kDrawnWhole : 0) | (behaviour_.keepsAreas ? wire::kKeepsAreas : 0);
        done.areas = areas_;
        done.busyNs = behaviour_.busyNs;
        sendStruct(wire::NodeMessage::FrameDone, done, {});
        return true;
    }

    void sendSpans(uint32_t client, uint32_t window, uint32_t frame) {
        const int64_t nowNs = monotonicNowNs(), beganNs = nowNs - kNsPerMs;
        const int64_t middleNs = beganNs + (behaviour_.overlappingSpans ? -1 : 1000);
        const wire::FrameSpan spans[] = {
            {static_cast<uint32_t>(wire::SpanKind::WaitPackets), 0, beganNs, beganNs + 1000},
            {static_cast<uint32_t>(wire::SpanKind::Replay), 0, middleNs, nowNs}};
        sendStruct(wire::NodeMessage::FrameSpans, wire::FrameSpansHeader{client, window, frame, 0, nowNs},
                   std::as_bytes(std::span(spans)));
    }

    bool answer(uint32_t client, uint32_t verb, const std::vector<uint32_t>& a) {
        if (a[0] == behaviour_.dieAtRequest && !behaviour_.halfAnswer) return false;
        wire::ReplyPartHeader header{};
        header.client = client;
        header.requestId = a[0];
        header.kind = verb - 1; // in the order of ReplyKind
        header.first = verb == kFakeBytes && setup_.node == 0;
        header.last = 1;
        std::vector<uint32_t> data;
        if (verb == kFakePixels) {
            const PixelViewport queried{static_cast<int32_t>(a[1]), static_cast<int32_t>(a[2]),
                                        static_cast<int32_t>(a[3]), static_cast<int32_t>(a[4])};
            // Windows of requests are 64 × 48 in these tests.
            PixelViewport mine = intersect(queried, region(64, 48));
            header.first = !mine.empty() && mine == queried;
            header.groupBytes = 4;
            if (a[0] == behaviour_.dieAtRequest) mine.h = 1; // half of it, then gone
            header.x = mine.x;
            header.y = mine.y;
            header.w = mine.w;
            header.h = mine.h;
            for (int32_t y = 0; y < mine.h; ++y)
                for (int32_t x = 0; x < mine.w; ++x)
                    data.push_back(static_cast<uint32_t>((mine.y + y) * 1000 + mine.x + x + 1));
        }
        if (verb == kFakeBytes) data.assign(a.size() > 1 ? a[1] : 3, 0x01020304);
        if (verb == kFakeSum) data = {10, 0, static_cast<uint32_t>(setup_.node), 0};
        if (a[0] == behaviour_.dieAtRequest) header.last = 0;
        sendStruct(wire::NodeMessage::ReplyPart, header, std::as_bytes(std::span(data)));
        return a[0] != behaviour_.dieAtRequest;
    }

    template <class Header>
    bool sendStruct(wire::NodeMessage type, const Header& header, std::span<const std::byte> bytes) {
        const wire::MessageHeader message{static_cast<uint32_t>(type),
                                          static_cast<uint32_t>(sizeof(header) + bytes.size())};
        return sendParts(message, std::as_bytes(std::span(&header, 1)), bytes);
    }
    void sendText(wire::NodeMessage type, const std::string& text) {
        const wire::MessageHeader message{static_cast<uint32_t>(type), static_cast<uint32_t>(text.size())};
        sendParts(message, std::as_bytes(std::span(text)), {});
    }
    bool sendParts(const wire::MessageHeader& message, std::span<const std::byte> a, std::span<const std::byte> b) {
        const Deadline deadline = Deadline::inMs(kTestPatienceMs);
        bool sent = connection_->write(std::as_bytes(std::span(&message, 1)), deadline).ok();
        if (sent && !a.empty()) sent = connection_->write(a, deadline).ok();
        if (sent && !b.empty()) sent = connection_->write(b, deadline).ok();
        connection_->flush();
        return sent;
    }

    std::unique_ptr<Connection> connection_;
    FakeNodeBehaviour behaviour_;
    NodeSetup setup_;
    uint32_t areas_ = 0;
    bool sendsSpans_ = false;
    bool goodbyeReceived_ = false;
    std::atomic<bool> stop_{false};
    mutable std::mutex mutex_;
    std::vector<Packet> packets_;
    std::thread thread_;
};

} // namespace mural
