#include "native/session/app_link.hpp"

#include <cstring>
#include <utility>

#include "common/ipc/futex.hpp"
#include "streamcodec/wire/object_records.hpp"

namespace mural::native {

namespace {

constexpr uint32_t kWindow = 1;         // id of the only window
constexpr int64_t kSliceNs = 2'000'000; // between checks for requests and for the end of the head

} // namespace

Result<std::unique_ptr<AppLink>> AppLink::connect(const std::string& session, TakeRequest takeRequest,
                                                  Deadline deadline) {
    auto link = CaptureLink::connect(session, capture::ProgramKind::Native, deadline);
    if (!link) return link.error();
    (*link)->onReply(
        [take = std::move(takeRequest)](const wire::ReplyHeader& header, std::span<const std::byte> bytes) {
            if (header.kind == static_cast<uint32_t>(wire::ReplyKind::Object)) take(header.requestId, bytes);
        });
    return std::unique_ptr<AppLink>(new AppLink(std::move(*link)));
}

AppLink::AppLink(std::unique_ptr<CaptureLink> link)
    : link_(std::move(link)), writer_([this](std::span<const std::byte> packet) { return send(packet); }) {}

void AppLink::sendObject(uint32_t node, std::span<const std::byte> message) {
    wire::splitIntoRecords(node, message, [this](std::span<const std::byte> record) { writer_.add(record); });
    // Bounds the memory of packets that the nodes do not accept.
    constexpr size_t kMaxWaitingBytes = size_t{64} << 20;
    constexpr int64_t kPatienceMs = 60'000;
    if (writer_.waitingBytes() > kMaxWaitingBytes && deadline_.passed()) deadline_ = Deadline::inMs(kPatienceMs);
    (void)writer_.sendComplete();
}

void AppLink::sendWindow(const wire::WindowConfig& window) {
    std::byte arguments[sizeof(uint32_t) + sizeof window];
    std::memcpy(arguments, &kWindow, sizeof kWindow);
    std::memcpy(arguments + sizeof kWindow, &window, sizeof window);
    writer_.add(wire::kOpWindow, arguments);
}

Result<void> AppLink::sendFrame(const wire::NativeFrame& frame, uint32_t number) {
    if (auto sent = flush(); !sent) return sent;
    const uint32_t swap[2] = {kWindow, number};
    writer_.add(wire::kOpFrame, std::as_bytes(std::span(&frame, 1)));
    writer_.add(wire::kOpSwap, std::as_bytes(std::span(swap)));
    const auto sent = flush(); // after the deadline, the next call sends it
    if (!sent && !isAlive()) return sent;
    link_->submitted(number);
    return {};
}

Result<void> AppLink::flush() { return writer_.flush(); }

void AppLink::serve() {
    (void)link_->unanswered();
    if (served_) served_();
}

// Requests are not served here: their replies would be written between the records of a message.
Result<void> AppLink::send(std::span<const std::byte> packet) {
    while (!link_->publish(0, packet)) {
        const uint32_t seen = link_->chunkWord().load();
        if (link_->publish(0, packet)) break;
        if (!isAlive()) return Error{"the session is over"};
        if (deadline_.passed()) return Error{"the render nodes accept no more data; see mural stat"};
        futexWait(link_->chunkWord(), seen, deadline_.leftNs(kSliceNs));
    }
    return {};
}

template <class Condition>
Result<void> AppLink::await(const std::atomic<uint32_t>& word, const char* what, Condition condition) {
    serve(); // also if nothing is waited for: nodes request objects ahead of their use
    while (true) {
        const uint32_t seen = word.load();
        if (condition()) return {};
        serve();
        if (!isAlive()) return Error{"the session is over"};
        if (auto sent = flush(); !sent) return sent; // replies to the requests
        if (deadline_.passed()) return Error{std::string(what) + "; see mural stat"};
        futexWait(word, seen, deadline_.leftNs(kSliceNs));
    }
}

Result<void> AppLink::awaitCredit(uint32_t frame) {
    return await(link_->framesWord(), "the render nodes have not finished earlier frames in time",
                 [&] { return link_->mayGoOn(frame); });
}

Result<void> AppLink::awaitDone(uint32_t frame) {
    return await(link_->framesWord(), "the render nodes have not finished all frames in time",
                 [&] { return static_cast<int32_t>(link_->framesWord().load() - frame) >= 0; });
}

void AppLink::serveUntil(Deadline deadline) {
    while (isAlive()) {
        const uint32_t seen = link_->answersWord().load();
        serve();
        if (!flush() || deadline.passed()) return;
        futexWait(link_->answersWord(), seen, deadline.leftNs(kSliceNs));
    }
}

} // namespace mural::native
