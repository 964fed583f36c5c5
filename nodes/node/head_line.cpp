#include "nodes/node/head_line.hpp"

#include <iostream>

#include "nodes/session/session_secret.hpp"

namespace mural {

namespace {

constexpr int64_t kSendMs = 20'000;
constexpr int64_t kConnectMs = 20'000;

// host:port, and the secret that proves that this node was asked for.
Result<std::unique_ptr<Connection>> connectByTcp(const std::string& address) {
    const size_t colon = address.rfind(':');
    if (colon == std::string::npos) return Error{"--connect " + address + ": give it as HOST:PORT"};
    std::string host = address.substr(0, colon);
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
    const long port = std::strtol(address.c_str() + colon + 1, nullptr, 10);
    if (port < 1 || port > 65535) return Error{"--connect " + address + ": the port is no number from 1 to 65535"};
    std::string line;
    std::getline(std::cin, line);
    const auto secret = sessionSecretFromHex(line);
    if (!secret) return Error{"no session secret on standard input: nodes are started by `mural run --nodes`"};
    auto connection = connectTcp(host, static_cast<uint16_t>(port), Deadline::inMs(kConnectMs));
    if (!connection) return connection.error();
    const auto sent = (*connection)->write(secret.value(), Deadline::inMs(kSendMs));
    if (!sent) return sent.error();
    (*connection)->flush();
    return std::move(*connection);
}

} // namespace

Result<std::unique_ptr<HeadLine>> HeadLine::open(const NodeOptions& options) {
    auto connection = options.connectFd >= 0 ? openSharedMemory(options.connectFd) : connectByTcp(options.connect);
    if (!connection) return connection.error();
    return std::unique_ptr<HeadLine>(new HeadLine(std::move(*connection)));
}

Result<wire::PacketHeader> HeadLine::next(std::span<const std::byte>& payload) {
    wire::PacketHeader header{};
    const auto got = connection_->read(std::as_writable_bytes(std::span(&header, 1)), Deadline::never());
    if (!got) return got.error();
    if (header.sizeBytes > wire::kMaxPacketBytes) return Error{"the head sent a packet of " + std::to_string(header.sizeBytes) + " bytes: it is of another build"};
    payload_.resize(header.sizeBytes);
    const auto rest = connection_->read(payload_, Deadline::inMs(kSendMs));
    if (!rest) return rest.error();
    payload = payload_;
    return header;
}

void HeadLine::send(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b) {
    const std::lock_guard lock(sending_);
    sendLocked(type, a, b);
}

void HeadLine::sendIfFree(wire::NodeMessage type) {
    const std::unique_lock lock(sending_, std::try_to_lock);
    if (lock) sendLocked(type, {}, {});
}

void HeadLine::sendLocked(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b) {
    const wire::MessageHeader header{static_cast<uint32_t>(type), static_cast<uint32_t>(a.size() + b.size())};
    for (const auto part : {std::as_bytes(std::span(&header, 1)), a, b}) {
        if (broken_ || part.empty()) continue;
        broken_ = !connection_->write(part, Deadline::inMs(kSendMs)).ok();
    }
    if (!broken_) connection_->flush();
}

void HeadLine::sendText(wire::NodeMessage type, const std::string& text) {
    send(type, std::as_bytes(std::span(text.data(), text.size())));
}

} // namespace mural
