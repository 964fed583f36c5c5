#include "nodes/head/broadcast/node_connection.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/log/log.hpp"
#include "nodes/frame_spans/frame_spans_message.hpp"
#include "nodes/frame_spans/span_scope.hpp"
#include "nodes/input/input_event_bytes.hpp"

namespace mural {
namespace {

using wire::NodeMessage;

constexpr int64_t kWatchGapNs = 2 * kNsPerS; // a longer gap between two checks means that the head itself was stopped
constexpr int64_t kWriteLimitMs = 600'000;   // a last resort: watch() loses silent nodes earlier
constexpr int64_t kReadSliceMs = 100;        // interval of the check whether the node was given up
constexpr int64_t kMessageLimitMs = 60'000;  // from a message's header to its last byte
constexpr int64_t kStatusPatienceMs = 300;   // a broken connection is detected before the process has ended
constexpr size_t kMaxQueuedBytes = size_t{256} << 20; // limit during resync
constexpr uint32_t kMaxTextBytes = 1u << 20;
constexpr uint32_t kMaxObjectRequestBytes = 1u << 20;
constexpr uint32_t kMaxDataBytes = (1u << 30) + 4096; // a picture of 16384 x 16384 pixels

std::span<std::byte> bytesOf(auto& value) { return std::as_writable_bytes(std::span(&value, 1)); }

// Checks that a rectangle has exactly `have` bytes.
bool rectangleFits(int32_t x, int32_t y, int32_t w, int32_t h, uint64_t pixelBytes, uint64_t have) {
    constexpr int32_t kLimit = 1 << 20;
    if (x < -kLimit || y < -kLimit || x > kLimit || y > kLimit) return false;
    if (w < 0 || h < 0 || w > kLimit || h > kLimit) return false;
    return uint64_t(w) * uint64_t(h) * pixelBytes == have;
}

} // namespace

NodeConnection::NodeConnection(NodeLocation location, std::unique_ptr<Connection> connection,
                               std::unique_ptr<RunningNode> process, NodeEvents& events)
    : location_(std::move(location)),
      connection_(std::move(connection)),
      process_(std::move(process)),
      events_(events),
      alive_(connection_ != nullptr),
      readerEnded_(connection_ == nullptr) {}

NodeConnection::~NodeConnection() { end(); }

void NodeConnection::startReading() {
    if (!connection_) return;
    lastMessageNs_ = receivedNs_ = monotonicNowNs();
    reader_ = std::thread([this] { readMessages(); });
}

std::string NodeConnection::describe() const {
    std::string text = "node " + std::to_string(location_.node) + " (" + location_.where;
    if (const pid_t pid = process_ ? process_->pid() : 0; pid > 0) text += ", pid " + std::to_string(pid);
    return text + ")";
}

void NodeConnection::send(std::span<const std::byte> header, std::span<const std::byte> payload) {
    if (feed_ == Feed::Direct) return sendNow(header, payload);
    if (feed_ == Feed::Nothing || !alive()) return;
    std::vector<std::byte> packet;
    packet.reserve(header.size() + payload.size());
    packet.insert(packet.end(), header.begin(), header.end());
    packet.insert(packet.end(), payload.begin(), payload.end());
    {
        const std::lock_guard lock(queueMutex_);
        queueBytes_ += packet.size();
        if (queueBytes_ <= kMaxQueuedBytes) return queue_.push_back(std::move(packet));
    }
    lose("it does not catch up: its queue exceeds " + std::to_string(kMaxQueuedBytes >> 20) + " MiB");
}

std::vector<std::vector<std::byte>> NodeConnection::takeQueue() {
    const std::lock_guard lock(queueMutex_);
    queueBytes_ = 0;
    return std::exchange(queue_, {});
}

bool NodeConnection::queueEmpty() const {
    const std::lock_guard lock(queueMutex_);
    return queue_.empty();
}

void NodeConnection::sendNow(std::span<const std::byte> header, std::span<const std::byte> payload) {
    if (!alive()) return;
    const Deadline deadline = Deadline::inMs(kWriteLimitMs);
    Result<void> written = connection_->write(header, deadline);
    if (written && !payload.empty()) written = connection_->write(payload, deadline);
    if (!written) lose(written.error().message);
}

void NodeConnection::flush() {
    if (feed_ == Feed::Direct) flushNow();
}

void NodeConnection::flushNow() {
    if (alive()) connection_->flush();
}

void NodeConnection::lose(const std::string& why) {
    const std::lock_guard lock(reasonMutex_); // release() must not free the connection meanwhile
    if (reason_.empty()) {
        log::debug(log::Topic::Node, "gives up node ", location_.node, ": ", why);
        reason_ = why;
    }
    if (alive_.exchange(false)) connection_->close();
}

void NodeConnection::watch(int64_t nowNs, int64_t patienceNs) {
    // If the head itself was stopped, the silence of the nodes meanwhile does not count.
    if (nowNs - std::exchange(watchedNs_, nowNs) > kWatchGapNs) excusedNs_ = nowNs;
    if (!alive() || goodbyeReceived() || inMessage_) return;
    if (nowNs - std::max(excusedNs_, receivedNs_.load()) <= patienceNs) return;
    lose("no message for " + std::to_string(patienceNs / kNsPerS) + " s (stopped, or its driver hangs)");
}

void NodeConnection::endAfterGoodbye(Deadline deadline) {
    if (!goodbyeReceived() || !readerEnded()) return;
    connection_->close();
    if (process_) process_->waitEnded(deadline);
}

void NodeConnection::end() {
    if (alive_.exchange(false)) connection_->close();
    if (reader_.joinable()) reader_.join();
    if (process_) process_->kill();
}

void NodeConnection::readMessages() {
    while (alive() && !goodbyeReceived()) {
        wire::MessageHeader header{};
        const Result<bool> got = readHeader(header);
        if (got && !got.value()) continue;
        inMessage_ = true;
        Result<void> done = got ? readMessage(header) : Result<void>(got.error());
        receivedNs_ = monotonicNowNs();
        inMessage_ = false;
        if (!done) lose(done.error().message);
    }
    if (!goodbyeReceived()) {
        events_.nodeLost(location_.node, reasonOfEnd());
        if (process_) process_->kill(); // it may still run and hold a GPU
    }
    alive_ = false;
    readerEnded_ = true;
}

// Returns false if no message has arrived yet.
Result<bool> NodeConnection::readHeader(wire::MessageHeader& header) {
    const Result<void> got = [&] {
        const SpanScope waits(SpanKind::WaitNode);
        return connection_->read(bytesOf(header), Deadline::inMs(kReadSliceMs));
    }();
    if (got) return true;
    if (!connection_->timedOut()) return got.error();
    // All messages have been read, so an ended process counts as lost now. A shared-memory connection does not report
    // its end.
    if (process_ && location_.where == "local") {
        if (const auto how = process_->ended()) return Error{*how};
    }
    return false;
}

Result<void> NodeConnection::readMessage(const wire::MessageHeader& header) {
    switch (static_cast<NodeMessage>(header.type)) {
    case NodeMessage::Ready:
    case NodeMessage::Log:
    case NodeMessage::Goodbye: return readText(header);
    case NodeMessage::ReplyPart: return readAnswer(header.sizeBytes);
    case NodeMessage::Picture: return readPicture(header.sizeBytes);
    case NodeMessage::PackedPicture: return readPackedPicture(header.sizeBytes);
    case NodeMessage::FrameDone: {
        wire::FrameDoneMessage message{};
        if (header.sizeBytes != sizeof(message)) break;
        if (auto got = readStruct(message); !got) return got;
        return handle([&] { return events_.nodeFrameDone(location_.node, message); });
    }
    case NodeMessage::WindowGone: {
        wire::WindowGoneMessage message{};
        if (header.sizeBytes != sizeof(message)) break;
        if (auto got = readStruct(message); !got) return got;
        forgetPictures(message);
        return handle([&] { return events_.nodeWindowGone(location_.node, message); });
    }
    case NodeMessage::DriverEvent: return readDriverEvent(header.sizeBytes);
    case NodeMessage::ObjectRequest: return readObjectRequest(header.sizeBytes);
    case NodeMessage::Alive:
        if (header.sizeBytes != 0) break;
        isHeard_ = true;
        return {};
    case NodeMessage::ViewReached: return readInView(header.sizeBytes);
    case NodeMessage::Turns: return readTurns(header.sizeBytes);
    case NodeMessage::Synchronized: {
        wire::SynchronizedMessage message{};
        if (header.sizeBytes != sizeof(message)) break;
        if (auto got = readStruct(message); !got) return got;
        return handle([&] { return events_.nodeSynchronized(location_.node, message); });
    }
    case NodeMessage::FrameSpans: return readFrameSpans(header.sizeBytes);
    case NodeMessage::ClockReply: {
        wire::ClockReplyMessage message{};
        if (header.sizeBytes != sizeof(message)) break;
        if (auto got = readStruct(message); !got) return got;
        if (!wire::isSensibleTime(message.sentNs) || !wire::isSensibleTime(message.arrivedNs) ||
            !wire::isSensibleTime(message.leftNs))
            break;
        return handle([&] { return events_.nodeClock(location_.node, message); });
    }
    case NodeMessage::PreviewTile: return readPreviewTile(header.sizeBytes);
    case NodeMessage::WindowInput: return readWindowInput(header.sizeBytes);
    case NodeMessage::OutputProof: {
        wire::OutputProofMessage message{};
        if (header.sizeBytes != sizeof(message)) break;
        if (auto got = readStruct(message); !got) return got;
        if (!wire::isSensibleTime(message.shownNs)) break;
        return handle([&] { return events_.nodeOutputProof(location_.node, message); });
    }
    }
    return Error{"it sent an invalid message (type " + std::to_string(header.type) + ", " +
                 std::to_string(header.sizeBytes) + " bytes); install the same version of mural on all machines"};
}

Result<void> NodeConnection::readText(const wire::MessageHeader& header) {
    if (header.sizeBytes > kMaxTextBytes) return Error{"it sent a text of more than 1 MiB"};
    auto bytes = readBytes(header.sizeBytes);
    if (!bytes) return bytes.error();
    const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    return handle([&] {
        if (header.type == static_cast<uint32_t>(NodeMessage::Ready)) return events_.nodeReady(location_.node, text);
        if (header.type == static_cast<uint32_t>(NodeMessage::Log)) return events_.nodeLog(location_.node, text);
        auto done = events_.nodeGoodbye(location_.node, text);
        goodbyeReceived_ = done.ok();
        return done;
    });
}

Result<void> NodeConnection::readInView(uint32_t sizeBytes) {
    uint32_t view = 0;
    std::vector<wire::ClientFrame> frames;
    if (auto got = readList(sizeBytes, view, frames, "frame positions"); !got) return got;
    return handle([&] { return events_.nodeInView(location_.node, view, frames); });
}

Result<void> NodeConnection::readTurns(uint32_t sizeBytes) {
    uint32_t number = 0;
    std::vector<std::byte> turns;
    if (auto got = readList(sizeBytes, number, turns, "its phase"); !got) return got;
    return handle([&] { return events_.nodeTurns(location_.node, number, turns); });
}

template <class Entry>
Result<void> NodeConnection::readList(uint32_t sizeBytes, uint32_t& first, std::vector<Entry>& entries,
                                      const char* what) {
    const size_t entriesBytes = sizeBytes - std::min<size_t>(sizeBytes, sizeof(first));
    if (sizeBytes < sizeof(first) || entriesBytes > kMaxTextBytes || entriesBytes % sizeof(Entry) != 0)
        return Error{std::string("it sent ") + what + " with an invalid size"};
    if (auto got = readStruct(first); !got) return got;
    entries.resize(entriesBytes / sizeof(Entry));
    if (entries.empty()) return {};
    return connection_->read(std::as_writable_bytes(std::span(entries)), Deadline::inMs(kMessageLimitMs));
}

Result<void> NodeConnection::readPreviewTile(uint32_t sizeBytes) {
    wire::PreviewTileHeader header{};
    if (sizeBytes < sizeof(header) || sizeBytes - sizeof(header) > wire::kMaxPreviewBytes)
        return Error{"it sent a preview of invalid size"};
    if (auto got = readStruct(header); !got) return got;
    std::vector<std::byte> jpeg(sizeBytes - sizeof(header));
    if (!jpeg.empty())
        if (auto got = connection_->read(jpeg, Deadline::inMs(kMessageLimitMs)); !got) return got;
    return handle([&] { return events_.nodePreviewTile(location_.node, header, jpeg); });
}

Result<void> NodeConnection::readFrameSpans(uint32_t sizeBytes) {
    wire::FrameSpansHeader header{};
    const size_t spansBytes = sizeBytes - std::min<size_t>(sizeBytes, sizeof(header));
    if (sizeBytes < sizeof(header) || spansBytes % sizeof(wire::FrameSpan) != 0 ||
        spansBytes > wire::kMaxFrameSpans * sizeof(wire::FrameSpan))
        return Error{"it sent statistics of invalid size"};
    if (auto got = readStruct(header); !got) return got;
    std::vector<wire::FrameSpan> spans(spansBytes / sizeof(wire::FrameSpan));
    if (!spans.empty()) {
        auto got = connection_->read(std::as_writable_bytes(std::span(spans)), Deadline::inMs(kMessageLimitMs));
        if (!got) return got;
    }
    if (auto valid = checkSpans(spans); !valid) return valid;
    if (!wire::isSensibleTime(header.sentNs)) return Error{"it sent statistics whose times are out of range"};
    return handle([&] { return events_.nodeFrameSpans(location_.node, header, spans); });
}

Result<void> NodeConnection::readWindowInput(uint32_t sizeBytes) {
    if (sizeBytes > input::kMaxEventBytes) return Error{"it sent an input event of invalid size"};
    auto bytes = readBytes(sizeBytes);
    if (!bytes) return bytes.error();
    const auto event = input::eventOfBytes(bytes->span());
    if (!event) return event.error();
    return handle([&] { return events_.nodeWindowInput(location_.node, *event); });
}

Result<void> NodeConnection::readDriverEvent(uint32_t sizeBytes) {
    wire::DriverEvent event{};
    if (sizeBytes < sizeof(event) || sizeBytes > sizeof(event) + kMaxTextBytes)
        return Error{"it sent a driver event of invalid size"};
    if (auto got = readStruct(event); !got) return got;
    if (event.textBytes != sizeBytes - sizeof(event))
        return Error{"it sent a driver event whose size contradicts its text"};
    auto bytes = readBytes(event.textBytes);
    if (!bytes) return bytes.error();
    const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    return handle([&] { return events_.nodeDriverEvent(location_.node, event, text); });
}

Result<void> NodeConnection::readObjectRequest(uint32_t sizeBytes) {
    uint32_t client = 0;
    if (sizeBytes <= sizeof client || sizeBytes > kMaxObjectRequestBytes)
        return Error{"it sent a request for objects of invalid size"};
    if (auto got = readStruct(client); !got) return got;
    auto message = readBytes(sizeBytes - sizeof client);
    if (!message) return message.error();
    return handle([&] { return events_.nodeObjectRequest(location_.node, client, std::move(*message)); });
}

Result<void> NodeConnection::readAnswer(uint32_t sizeBytes) {
    wire::ReplyPartHeader header{};
    if (sizeBytes < sizeof(header) || sizeBytes > kMaxDataBytes) return Error{"it sent a reply of invalid size"};
    if (auto got = readStruct(header); !got) return got;
    const uint32_t dataBytes = sizeBytes - static_cast<uint32_t>(sizeof(header));
    const bool rectangle = header.kind == static_cast<uint32_t>(wire::ReplyKind::Rectangle);
    const bool fits = !rectangle || (header.groupBytes <= 64 && rectangleFits(header.x, header.y, header.w, header.h,
                                                                              header.groupBytes, dataBytes));
    if (!fits) return Error{"it sent a reply whose rectangle contradicts its size"};
    auto bytes = readBytes(dataBytes);
    if (!bytes) return bytes.error();
    return handle([&] { return events_.nodeAnswer(location_.node, header, std::move(*bytes)); });
}

Result<void> NodeConnection::readPicture(uint32_t sizeBytes) {
    wire::PictureHeader header{};
    if (sizeBytes < sizeof(header) || sizeBytes > kMaxDataBytes) return Error{"it sent a picture of invalid size"};
    if (auto got = readStruct(header); !got) return got;
    const uint32_t dataBytes = sizeBytes - static_cast<uint32_t>(sizeof(header));
    const ScaledSize size = scaledSizeOf(header.w, header.h, transferScale_);
    if (!rectangleFits(header.x, header.y, size.w, size.h, 4, dataBytes))
        return Error{"it sent a picture whose rectangle contradicts its size"};
    auto rows = readBytes(dataBytes);
    if (!rows) return rows.error();
    return handle([&] { return events_.nodePicture(location_.node, header, std::move(*rows)); });
}

Result<void> NodeConnection::readPackedPicture(uint32_t sizeBytes) {
    wire::PictureHeader header{};
    if (!pictures_) return Error{"it sent an encoded picture that was not requested"};
    if (sizeBytes < sizeof(header) || sizeBytes > kMaxDataBytes) return Error{"it sent a picture of invalid size"};
    if (auto got = readStruct(header); !got) return got;
    auto packed = readBytes(sizeBytes - static_cast<uint32_t>(sizeof(header)));
    if (!packed) return packed.error();
    const ScaledSize size = scaledSizeOf(header.w, header.h, transferScale_);
    const uint64_t pixels = size.w > 0 && size.h > 0 ? uint64_t(size.w) * uint64_t(size.h) : 0;
    if (pixels == 0 || pixels > kMaxDataBytes / 4) return Error{"it sent an encoded picture of invalid size"};
    return handle([&]() -> Result<void> {
        ByteBuffer rows = ByteBuffer::ofSize(pixels * 4);
        if (rows.size() != pixels * 4) return Error{"no memory for a picture of " + std::to_string(pixels) + " pixels"};
        const auto unpack = [&] {
            const SpanScope decodes(SpanKind::Decode);
            return pictures_->unpack(header.client, header.window, size.w, size.h, packed->span(), rows.span());
        };
        if (auto done = unpack(); !done)
            return Error{"it sent a picture that cannot be decoded: " + done.error().message};
        pictureBytes_ += static_cast<int64_t>(packed->size());
        pictureRawBytes_ += static_cast<int64_t>(rows.size());
        return events_.nodePicture(location_.node, header, std::move(rows));
    });
}

void NodeConnection::forgetPictures(const wire::WindowGoneMessage& gone) {
    if (!pictures_) return;
    if (gone.window == wire::kAllWindows)
        pictures_->clientGone(gone.client);
    else
        pictures_->windowGone(gone.client, gone.window);
}

template <class Header> Result<void> NodeConnection::readStruct(Header& header) {
    return connection_->read(bytesOf(header), Deadline::inMs(kMessageLimitMs));
}

Result<ByteBuffer> NodeConnection::readBytes(size_t sizeBytes) {
    ByteBuffer buffer = ByteBuffer::ofSize(sizeBytes);
    if (buffer.size() != sizeBytes) return Error{"no memory for a message of " + std::to_string(sizeBytes) + " bytes"};
    if (sizeBytes == 0) return buffer;
    const SpanScope receives(SpanKind::Receive);
    auto got = connection_->read(buffer.span(), Deadline::inMs(kMessageLimitMs));
    if (!got) return got.error();
    return buffer;
}

template <class Handler> Result<void> NodeConnection::handle(Handler&& handler) {
    handlingSinceNs_ = monotonicNowNs();
    Result<void> done = handler();
    lastMessageNs_ = monotonicNowNs();
    handlingSinceNs_ = 0;
    return done;
}

// The exit status is a better explanation than the broken connection.
std::string NodeConnection::reasonOfEnd() {
    if (process_) {
        // On another host the command that reaches the node has ended, such as ssh. Its name avoids confusion with the
        // node.
        if (const auto how = process_->waitEnded(Deadline::inMs(kStatusPatienceMs))) {
            const std::string details = process_->details();
            return details.starts_with(" of ") || details.starts_with(": ") ? *how + details : *how;
        }
    }
    const std::lock_guard lock(reasonMutex_);
    return reason_.empty() ? "its connection ended" : reason_;
}

} // namespace mural
