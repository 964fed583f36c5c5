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

void AppLink::keep(const Result<void>& result) {
    if (!result && failure_) failure_ = result;
}

void AppLink::sendObject(uint32_t node, std::span<const std::byte> message) {
    if (message.size() > wire::kMaxObjectBytes)
        return keep(Error{"an object has more than 1 GiB; use a Blob for its data"});
    wire::splitIntoRecords(node, message, [this](std::span<const std::byte> record) { keep(writer_.add(record)); });
}

Result<void> AppLink::sendWindow(const wire::WindowConfig& window) {
    std::byte arguments[sizeof(uint32_t) + sizeof window];
    std::memcpy(arguments, &kWindow, sizeof kWindow);
    std::memcpy(arguments + sizeof kWindow, &window, sizeof window);
    return writer_.add(wire::kOpWindow, arguments);
}

Result<void> AppLink::sendFrame(const wire::NativeFrame& frame, uint32_t number) {
    const uint32_t swap[2] = {kWindow, number};
    keep(writer_.add(wire::kOpFrame, std::as_bytes(std::span(&frame, 1))));
    keep(writer_.add(wire::kOpSwap, std::as_bytes(std::span(swap))));
    auto sent = flush();
    if (sent) link_->submitted(number);
    return sent;
}

Result<void> AppLink::flush() {
    keep(writer_.flush());
    return std::exchange(failure_, {});
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
    while (true) {
        const uint32_t seen = word.load();
        if (condition()) return {};
        (void)link_->unanswered(); // serves requests
        if (!isAlive()) return Error{"the session is over"};
        if (auto sent = flush(); !sent) return sent;
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

void AppLink::serve(Deadline deadline) {
    while (isAlive()) {
        const uint32_t seen = link_->answersWord().load();
        (void)link_->unanswered();
        if (!flush() || deadline.passed()) return;
        futexWait(link_->answersWord(), seen, deadline.leftNs(kSliceNs));
    }
}

} // namespace mural::native
