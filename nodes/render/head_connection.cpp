#include "nodes/render/head_connection.hpp"

#include <iostream>
#include <sstream>

#include "common/log/log.hpp"
#include "nodes/frame_spans/span_scope.hpp"
#include "nodes/session/session_secret.hpp"
#include "transport/connection_description.hpp"
#include "transport/rsp/group_connection.hpp"
#include "transport/rsp/group_description.hpp"
#include "transport/secure/secure_connection.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural {

namespace {

constexpr int64_t kChangeOverMs = 20'000;
constexpr int64_t kConnectMs = 20'000;
constexpr int64_t kJoinMs = 10'000;
constexpr int64_t kBesideMs = 2; // delay of packets to this node only, beside a group

constexpr int64_t kTryMs = 2'000; // for one of several endpoints

std::vector<std::string> endpointsOf(const std::string& text) {
    std::vector<std::string> all;
    std::istringstream stream(text);
    for (std::string one; std::getline(stream, one, ',');) all.push_back(one);
    return all;
}

// Connects to the first endpoint that answers with the secret, and names its host in `headHost`. The secret proves to
// the head that it started this node, and to the node that the peer is the head.
Result<std::unique_ptr<Connection>> connectByTcp(const NodeOptions& options, std::string& headHost) {
    std::vector<HostPort> endpoints;
    for (const std::string& text : endpointsOf(options.connect)) {
        auto where = splitHostPort(text);
        if (!where || where->host.empty() || where->port == 0)
            return Error{"--connect " + options.connect +
                         ": give it as HOST:PORT, with a port from 1 to 65535; several separated by commas"};
        endpoints.push_back(std::move(*where));
    }
    std::string line;
    std::getline(std::cin, line);
    const auto secret = sessionSecretFromHex(line);
    if (!secret) return Error{"no session secret on standard input; nodes are started by `mural run --nodes`"};
    std::string why;
    for (const HostPort& where : endpoints) {
        const Deadline deadline = Deadline::inMs(endpoints.size() == 1 ? kConnectMs : kTryMs);
        auto connection = connectTcp(where.host, where.port, deadline);
        auto secure = connection
                          ? SecureConnection::connecting(std::move(*connection), options.name, secret.value(), deadline)
                          : Result<std::unique_ptr<SecureConnection>>(connection.error());
        if (secure) {
            headHost = where.host;
            return std::unique_ptr<Connection>(std::move(*secure));
        }
        why += (why.empty() ? "" : "; ") + secure.error().message;
    }
    return Error{why};
}

} // namespace

Result<std::unique_ptr<HeadConnection>> HeadConnection::open(const NodeOptions& options) {
    std::string headHost;
    auto connection = options.connectFd >= 0 ? openSharedMemory(options.connectFd) : connectByTcp(options, headHost);
    if (!connection) return connection.error();
    std::unique_ptr<HeadConnection> line(new HeadConnection(std::move(*connection)));
    line->headHost_ = std::move(headHost);
    return line;
}

// Uses the network interface and the address that reach the head.
Result<rsp::GroupOptions> HeadConnection::groupOptions(const std::string& stream, const std::string& secretHex,
                                                       const std::string& name) const {
    auto description = parseConnectionDescription(stream);
    if (!description) return description.error();
    auto options = rsp::groupOptionsOf(*description);
    if (!options) return options.error();
    const auto secret = sessionSecretFromHex(secretHex);
    if (!secret) return secret.error();
    options->secret = secret.value();
    options->name = name;
    auto control = splitHostPort(options->control);
    if (!control) return control.error();
    options->control = endpointText(headHost_, control->port);
    options->interface = connection_->path().ownAddress;
    return options;
}

Result<void> HeadConnection::follow(const std::string& stream, const std::string& secretHex, const std::string& name) {
    auto options = groupOptions(stream, secretHex, name);
    if (!options) return options.error();
    auto joined = rsp::joinGroup(*options, Deadline::inMs(kJoinMs));
    if (!joined) return joined.error();
    stream_ = std::move(*joined);
    receiveBeside();
    return {};
}

HeadConnection::~HeadConnection() {
    if (!beside_.joinable()) return;
    connection_->close();
    beside_.join();
}

// Reads packets to this node only until the end of the connection.
void HeadConnection::receiveBeside() {
    beside_ = std::thread([this] {
        while (true) {
            OwnPacket packet;
            if (!connection_->read(std::as_writable_bytes(std::span(&packet.header, 1)), Deadline::never())) return;
            if (packet.header.sizeBytes > wire::kMaxPacketBytes) return connection_->close();
            packet.payload.resize(packet.header.sizeBytes);
            if (!connection_->read(packet.payload, Deadline::never())) return;
            const std::lock_guard lock(besideMutex_);
            own_.push_back(std::move(packet));
            hasOwn_ = true;
        }
    });
}

bool HeadConnection::takeBeside(wire::PacketHeader& header, std::span<const std::byte>& payload) {
    const std::lock_guard lock(besideMutex_);
    if (own_.empty()) return false;
    header = own_.front().header;
    payload_ = std::move(own_.front().payload);
    own_.pop_front();
    payload = payload_;
    return true;
}

void HeadConnection::joinBeside(const std::string& stream, const std::string& secretHex, const std::string& name) {
    const auto failed = [](const std::string& why) {
        log::warning(log::Topic::Stream, "its stream uses TCP instead of multicast: ", why,
                     "; see mural doctor --network");
    };
    auto options = groupOptions(stream, secretHex, name);
    if (!options) return failed(options.error().message);
    late_ = std::make_unique<StagedMulticastJoin>(std::move(*options), failed);
}

Result<void> HeadConnection::changeOver(uint64_t skipBytes) {
    if (!late_) return Error{"the head sent no multicast group"};
    if (auto ended = endBatch(); !ended) return ended;
    auto stream = late_->goOn(skipBytes, Deadline::inMs(kChangeOverMs));
    late_.reset();
    if (!stream) return stream.error();
    stream_ = std::move(*stream);
    receiveBeside();
    log::debug(log::Topic::Stream, "receives by multicast from now on");
    if (deltaDecoder_) {
        const auto had = readBatch();
        return had ? Result<void>() : had.error();
    }
    std::span<const std::byte> payload;
    const auto had = readPacket(payload);
    return had ? Result<void>() : had.error();
}

// Requires that the current command is the last one in its batch, because later packets are read in another way.
Result<void> HeadConnection::endBatch() {
    if (!inBatch_) return {};
    uint32_t stream = 0;
    std::span<const std::byte> payload;
    const auto more = deltaDecoder_->next(stream, payload);
    if (!more || more.value())
        return Error{
            "the head sent data after the last command of a batch; install the same version of mural on all machines"};
    inBatch_ = false;
    return {};
}

Result<void> HeadConnection::decodeBatches(uint64_t cacheBytes, const std::string& plant) {
    delta::Limits limits;
    limits.cacheBytes = cacheBytes;
    if (auto ended = endBatch(); !ended) return ended;
    deltaDecoder_.reset(); // frees the old memory before the new allocation
    batchDecoder_ = std::make_unique<delta::BatchDecoder>();
    deltaDecoder_ = std::make_unique<delta::DeltaDecoder>(limits);
    if (!deltaDecoder_->ready())
        return Error{"no memory for a delta cache of " + std::to_string(cacheBytes >> 20) +
                     " MiB; choose a smaller --cache-size"};
    if (plant == "delta") deltaDecoder_->loseWords();
    return {};
}

Result<wire::PacketHeader> HeadConnection::next(std::span<const std::byte>& payload) {
    auto header = nextBefore(payload, Deadline::never());
    if (!header) return header.error();
    return *header.value(); // without a deadline there is a packet or an error
}

Result<std::optional<wire::PacketHeader>> HeadConnection::nextBefore(std::span<const std::byte>& payload,
                                                                     Deadline deadline) {
    const bool isTimed = deadline.leftNs() != INT64_MAX;
    wire::PacketHeader header{};
    while (true) {
        auto more = nextOfBatch(header, payload);
        if (more && more.value()) return std::optional(header);
        if (more && hasOwn_ && takeBeside(header, payload)) return std::optional(header);
        if (more) {
            if (isTimed || hasOwn_) {
                const bool isSlice = hasOwn_ || beside_.joinable();
                auto begun = awaitFirst(isSlice ? Deadline::inMs(kBesideMs) : deadline);
                if (!begun) return begun.error();
                if (!begun.value() && isTimed && deadline.passed()) return std::optional<wire::PacketHeader>();
                if (!begun.value()) continue;
            }
            if (!deltaDecoder_) {
                auto packet = readPacket(payload);
                if (!packet) return packet.error();
                return std::optional(packet.value());
            }
            auto head = readBatch();
            if (!head) return head.error();
            if (head.value() == delta::BatchHead{}) {
                auto packet = readPacket(payload); // to this node only
                if (!packet) return packet.error();
                return std::optional(packet.value());
            }
            if (const auto opened = openBatch(head.value()); !opened) more = opened.error();
        }
        if (more) continue;
        log::error(log::Topic::Stream, more.error().message);
        return more.error();
    }
}

Result<bool> HeadConnection::nextOfBatch(wire::PacketHeader& header, std::span<const std::byte>& payload) {
    if (!inBatch_) return false;
    const SpanScope decodes(SpanKind::Decode);
    auto more = deltaDecoder_->next(header.stream, payload);
    inBatch_ = more && more.value();
    header.sizeBytes = static_cast<uint32_t>(payload.size());
    return more;
}

Result<void> HeadConnection::openBatch(delta::BatchHead head) {
    const SpanScope decodes(SpanKind::Decode);
    const auto sections = batchDecoder_->decode(head, payload_);
    if (!sections) return sections.error();
    deltaDecoder_->begin(sections.value());
    inBatch_ = true;
    return {};
}

// Waits for the first bytes of a packet or batch.
Result<void> HeadConnection::readFirst(std::span<std::byte> bytes) {
    const SpanScope waits(SpanKind::WaitPackets);
    if (first_ && !bytes.empty()) {
        bytes.front() = *std::exchange(first_, std::nullopt);
        bytes = bytes.subspan(1);
    }
    return bytes.empty() ? Result<void>() : line().read(bytes, Deadline::never());
}

// Returns false if nothing comes before the deadline.
Result<bool> HeadConnection::awaitFirst(Deadline deadline) {
    if (first_) return true;
    const SpanScope waits(SpanKind::WaitPackets);
    std::byte byte{};
    const auto got = line().read(std::span(&byte, 1), deadline);
    if (!got && line().timedOut()) return false;
    if (!got) return got.error();
    first_ = byte;
    return true;
}

Result<wire::PacketHeader> HeadConnection::readPacket(std::span<const std::byte>& payload) {
    wire::PacketHeader header{};
    const auto got = readFirst(std::as_writable_bytes(std::span(&header, 1)));
    if (!got) return got.error();
    const auto rest = readPayload(header.sizeBytes, wire::kMaxPacketBytes);
    if (!rest) return rest.error();
    payload = payload_;
    return header;
}

Result<delta::BatchHead> HeadConnection::readBatch() {
    delta::BatchHeadReader head;
    std::byte byte{};
    do {
        const auto got = readFirst(std::span(&byte, 1));
        if (!got) return got.error();
    } while (!head.add(byte));
    const auto rest = readPayload(head.head().sizeBytes, wire::kMaxBatchBytes);
    if (!rest) return rest.error();
    return head.head();
}

Result<void> HeadConnection::readPayload(uint32_t sizeBytes, uint32_t maxBytes) {
    if (sizeBytes > maxBytes)
        return Error{"the head sent an invalid packet of " + std::to_string(sizeBytes) +
                     " bytes; install the same version of mural on all machines"};
    payload_.resize(sizeBytes);
    const SpanScope receives(SpanKind::Receive);
    // no deadline: the head may pause in the middle; its end closes the connection
    return line().read(payload_, Deadline::never());
}

void HeadConnection::send(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b) {
    const std::lock_guard lock(sending_);
    sendLocked(type, a, b);
}

void HeadConnection::sendIfFree(wire::NodeMessage type) {
    const std::unique_lock lock(sending_, std::try_to_lock);
    if (lock) sendLocked(type, {}, {});
}

void HeadConnection::sendLocked(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b) {
    const wire::MessageHeader header{static_cast<uint32_t>(type), static_cast<uint32_t>(a.size() + b.size())};
    for (const auto part : {std::as_bytes(std::span(&header, 1)), a, b}) {
        if (broken_ || part.empty()) continue;
        broken_ = !connection_->write(part, Deadline::never()).ok(); // no deadline, as in readPayload()
    }
    // FrameDone follows FrameSpans at once. One flush for both wakes the head's reader only once.
    if (!broken_ && type != wire::NodeMessage::FrameSpans) connection_->flush();
}

void HeadConnection::sendText(wire::NodeMessage type, const std::string& text) {
    send(type, std::as_bytes(std::span(text.data(), text.size())));
}

} // namespace mural
