#include "nodes/trace_player/player.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <ctime>
#include <vector>

#include "common/ipc/futex.hpp"
#include "nodes/capture_link/capture_link.hpp"
#include "nodes/trace_player/player_windows.hpp"
#include "streamcodec/trace/trace_reader.hpp"
#include "streamcodec/wire/record_walk.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {
namespace {

using wire::RecordView;

constexpr int64_t kWelcomePatienceMs = 30'000;
constexpr int64_t kRoomPatienceMs = 60'000;
constexpr int64_t kFramePatienceMs = 600'000; // the same as for programs
constexpr int64_t kLeavePatienceMs = 5'000;
constexpr int64_t kSliceNs = 10 * kNsPerMs; // interval at which replies to the other programs are dropped
constexpr uint64_t kMaxUnanswered = 16; // maximum number of requests without a reply; the player ignores their replies

bool requestsReply(uint16_t opcode) {
    switch (opcode) {
    case wire::kOpRequestPixels:
    case wire::kOpRequestTexImage:
    case wire::kOpRequestBuffer:
    case wire::kOpRequestQuery:
    case wire::kOpRequestProgram:
    case wire::kOpFinish: return true;
    default: return false;
    }
}

class Player {
public:
    explicit Player(const PlayOptions& options)
        : options_(options), windows_("Mural: " + options.file, options.session) {}

    Result<void> play(trace::TraceReader& reader, bool& unreadable) {
        beganNs_ = monotonicNowNs();
        firstNs_ = -1;
        for (size_t i = 0; i < reader.blocks().size(); ++i) {
            auto block = reader.read(i);
            unreadable = !block;
            if (!block) return block.error();
            trace::EntryWalk walk(*block);
            trace::Entry entry;
            while (walk.next(entry))
                if (auto r = perform(entry); !r) return r;
        }
        while (!links_.empty())
            if (auto r = leave(links_.begin()->first); !r) return r;
        return {};
    }

private:
    // Waits on the word until done() holds. Drops the replies to all programs meanwhile.
    template <class Done>
    Result<void> await(CaptureLink& link, const std::atomic<uint32_t>& word, int64_t patienceMs, const char* what,
                       Done done) {
        const Deadline deadline = Deadline::inMs(patienceMs);
        while (true) {
            const uint32_t value = word.load(std::memory_order_acquire);
            if (done()) return {};
            dropAnswers();
            if (link.headGone() || link.gone(0)) return Error{"the session ended before the end of the trace"};
            if (deadline.passed())
                return Error{std::string("the session ") + what + " for " + std::to_string(patienceMs / 1000) +
                             " s; see mural stat"};
            futexWait(word, value, deadline.leftNs(kSliceNs));
        }
    }

    void dropAnswers() {
        for (auto& [client, link] : links_) (void)link->unanswered();
    }

    void keepPace(uint64_t timeNs) {
        if (firstNs_ < 0) firstNs_ = static_cast<int64_t>(timeNs);
        const Deadline due = Deadline::at(beganNs_ + static_cast<int64_t>(timeNs) - firstNs_);
        while (!due.passed()) {
            dropAnswers();
            const int64_t leftNs = due.leftNs(kSliceNs);
            const timespec slice{0, static_cast<long>(leftNs)};
            nanosleep(&slice, nullptr);
        }
    }

    Result<void> perform(const trace::Entry& entry) {
        if (options_.pace) keepPace(entry.timeNs);
        if (entry.stream == 0) {
            trace::ClientEvent event;
            const bool gone = trace::parseEvent(entry.payload, event) && event.kind == trace::Event::ClientGone;
            return gone ? leave(event.client) : Result<void>();
        }
        auto link = linkOf(wire::clientOf(entry.stream));
        if (!link) return link.error();
        return send(**link, entry.stream, entry.payload);
    }

    Result<CaptureLink*> linkOf(uint32_t client) {
        auto& link = links_[client];
        if (link) return link.get();
        auto connected =
            CaptureLink::connect(options_.session, capture::ProgramKind::Captured, Deadline::inMs(kWelcomePatienceMs));
        if (!connected) {
            links_.erase(client);
            return connected.error();
        }
        link = std::move(*connected);
        return link.get();
    }

    Result<void> send(CaptureLink& link, uint32_t stream, std::span<const std::byte> packet) {
        if (packet.size() > capture::kChunkBytes)
            return Error{"the trace has a packet of " + std::to_string(packet.size()) +
                         " bytes, more than a program can send; record it again"};
        // Waits until the previous program's packets are taken, so that nodes receive all packets in the recorded
        // order.
        if (last_ != nullptr && last_ != &link)
            if (auto r = await(*last_, last_->chunkWord(), kRoomPatienceMs, "did not read",
                               [&] { return last_->allTaken(); });
                !r)
                return r;
        last_ = &link;
        uint32_t frame = wire::kUnseenFrame;
        if (auto r = await(link, link.answersWord(), kRoomPatienceMs, "did not reply",
                           [&] { return link.unanswered() <= kMaxUnanswered; });
            !r)
            return r;
        if (auto r = prepare(link, stream, packet, frame); !r) return r;
        const auto thread = static_cast<uint16_t>(stream);
        if (auto r = await(link, link.chunkWord(), kRoomPatienceMs, "did not read",
                           [&] { return link.publish(thread, packet_); });
            !r)
            return r;
        if (frame == wire::kUnseenFrame) return {};
        link.submitted(frame);
        return await(link, link.framesWord(), kFramePatienceMs, "finished no frame",
                     [&] { return link.mayGoOn(frame); });
    }

    // Copies the recorded packet to packet_ and replaces its windows by existing ones. frame: the last frame that it
    // shows; unchanged if there is none.
    Result<void> prepare(CaptureLink& link, uint32_t stream, std::span<const std::byte> packet, uint32_t& frame) {
        packet_.assign(packet.begin(), packet.end());
        wire::RecordWalk walk(packet);
        RecordView r;
        while (walk.next(r)) {
            const uint32_t first = wire::argumentWord(r, 0);
            if (r.opcode == wire::kOpSwap || r.opcode == wire::kOpFrontPicture)
                frame = std::max(frame, wire::argumentWord(r, 1));
            else if (requestsReply(r.opcode) && !(first & capture::kPrefetched))
                link.requested();
            else if (!link.welcome().displayApp)
                continue;
            else if (r.opcode == wire::kOpDestroyWindow)
                windows_.destroy(wire::clientOf(stream), first);
            else if (r.opcode == wire::kOpWindow)
                if (auto shown = showWindow(link, stream, r); !shown) return shown;
        }
        return {};
    }

    Result<void> showWindow(const CaptureLink& link, uint32_t stream, const RecordView& r) {
        wire::WindowConfig config{};
        if (r.arguments.size() < 4 + sizeof config) return {};
        std::memcpy(&config, r.arguments.data() + 4, sizeof config);
        if ((config.nativeLow == 0 && config.nativeHigh == 0) || config.isPbuffer) return {};
        auto shown = windows_.show(wire::clientOf(stream), link.welcome().clientId, wire::argumentWord(r, 0),
                                   config.width, config.height);
        if (!shown) return shown.error();
        config.nativeLow = *shown;
        config.nativeHigh = 0;
        std::memcpy(packet_.data() + r.offset + r.sizeBytes - r.arguments.size() + 4, &config, sizeof config);
        return {};
    }

    Result<void> leave(uint32_t client) {
        const auto found = links_.find(client);
        if (found == links_.end()) return {};
        CaptureLink& link = *found->second;
        const auto taken =
            await(link, link.chunkWord(), kRoomPatienceMs, "did not read", [&] { return link.allTaken(); });
        link.leave();
        // Waits for the head, so that the next program's packets follow the end of this one.
        const Deadline deadline = Deadline::inMs(kLeavePatienceMs);
        while (taken && !deadline.passed() && !link.gone(kSliceNs / kNsPerMs)) dropAnswers();
        if (last_ == &link) last_ = nullptr;
        links_.erase(found);
        return taken;
    }

    const PlayOptions& options_;
    PlayerWindows windows_;
    std::map<uint32_t, std::unique_ptr<CaptureLink>> links_; // key: the client's recorded number
    CaptureLink* last_ = nullptr;                            // link of the last packet
    std::vector<std::byte> packet_;
    int64_t beganNs_ = 0;
    int64_t firstNs_ = -1; // recorded time of the first entry
};

int complain(const std::string& text, int status) {
    std::fprintf(stderr, "mural: %s\n", text.c_str());
    return status;
}

} // namespace

int playRecording(const PlayOptions& options) {
    constexpr int kFailed = 1, kUnreadable = 2;
    auto reader = trace::TraceReader::open(options.file);
    if (!reader) return complain(reader.error().message, kUnreadable);
    Player player(options);
    do {
        bool unreadable = false;
        if (const auto played = player.play(**reader, unreadable); !played)
            return complain(played.error().message, unreadable ? kUnreadable : kFailed);
    } while (options.loop && !(*reader)->blocks().empty());
    return 0;
}

} // namespace mural
