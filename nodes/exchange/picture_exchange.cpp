#include "nodes/exchange/picture_exchange.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <utility>

#include "common/base/little_endian.hpp"
#include "common/log/log.hpp"
#include "transport/tcp/free_port.hpp"
#include "transport/secure/secure_connection.hpp"

namespace mural {

namespace {

const std::string kName = "range";
constexpr int64_t kAcceptSliceMs = 100;
constexpr int64_t kProofPatienceMs = 5000;
constexpr size_t kWelcomeBytes = 4; // first message to a connecting node: the incarnation of this end

std::string rangeText(int rank) { return "range " + std::to_string(rank + 1); }

std::vector<std::byte> welcomeOf(uint32_t incarnation) {
    std::vector<std::byte> message(kWelcomeBytes);
    storeLittle(message.data(), incarnation);
    return message;
}

} // namespace

std::string PictureExchange::textOf(const Name& name) {
    return kName + std::to_string(name.rank) + "." + std::to_string(name.incarnation);
}

std::optional<PictureExchange::Name> PictureExchange::nameOf(const std::string& text) {
    Name name;
    if (!text.starts_with(kName)) return std::nullopt;
    const char* const end = text.data() + text.size();
    const auto rank = std::from_chars(text.data() + kName.size(), end, name.rank);
    if (rank.ec != std::errc() || rank.ptr == end || *rank.ptr != '.' || name.rank < 0) return std::nullopt;
    const auto incarnation = std::from_chars(rank.ptr + 1, end, name.incarnation);
    return incarnation.ec == std::errc() && incarnation.ptr == end ? std::optional(name) : std::nullopt;
}

Result<void> PictureExchange::listen(bool loopbackOnly) {
    auto free = listenOnFreePort(loopbackOnly);
    if (!free) return free.error();
    port_ = free->port;
    listener_ = std::move(free->listener);
    thread_ = std::thread([this] { letIn(); });
    return {};
}

Result<void> PictureExchange::connectTo(int rank, const std::string& host, uint16_t port, Deadline deadline) {
    auto connection = connectTcp(host, port, deadline);
    if (!connection) return connection.error();
    auto secure = SecureConnection::connecting(std::move(*connection), textOf(own_), secret_, deadline);
    if (!secure) return secure.error();
    std::array<std::byte, 4 + kWelcomeBytes> welcome; // after the length prefix
    if (auto came = (*secure)->read(welcome, deadline); !came) return came.error();
    if (loadLittle<uint32_t>(welcome.data()) != kWelcomeBytes)
        return Error{"no greeting from the node; install the same version of mural on all machines"};
    add({rank, loadLittle<uint32_t>(welcome.data() + 4)}, std::move(*secure), Side::Connected);
    return {};
}

PictureExchange::~PictureExchange() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    if (thread_.joinable()) thread_.join();
}

void PictureExchange::Link::end() {
    if (connection) connection->close(); // otherwise its sender would block
    sender.reset();
    connection.reset();
}

// The welcome message confirms the connection. The connection is not used before.
void PictureExchange::add(const Name& name, std::unique_ptr<Connection> connection, Side side) {
    const std::lock_guard lock(mutex_);
    Peer& peer = peers_[name.rank];
    Link& link = !peer.link.connection && !peer.gone ? peer.link : peer.next[name.incarnation];
    if (link.connection) return; // the first connection wins
    log::debug(log::Topic::Exchange, rangeText(name.rank), ", incarnation ", name.incarnation,
               side == Side::Accepted ? ", has connected" : " is connected");
    link.connection = std::move(connection);
    link.sender = std::make_unique<PartSender>(*link.connection);
    link.incarnation = name.incarnation;
    // the queue is empty: cannot block
    if (side == Side::Accepted) (void)link.sender->send(welcomeOf(own_.incarnation), Deadline::inMs(kProofPatienceMs));
    arrived_.notify_all();
}

void PictureExchange::renew(int rank, uint32_t incarnation) {
    std::vector<Link> before;
    {
        const std::lock_guard lock(mutex_);
        Peer& peer = peers_[rank];
        if (!peer.link.connection || peer.link.incarnation != incarnation) {
            before.push_back(std::exchange(peer.link, {}));
            if (const auto found = peer.next.find(incarnation); found != peer.next.end())
                peer.link = std::exchange(found->second, {});
        }
        peer.gone = !peer.link.connection;
        while (!peer.next.empty() && peer.next.begin()->first <= incarnation)
            before.push_back(std::move(peer.next.extract(peer.next.begin()).mapped()));
    }
    for (Link& link : before) link.end();
}

void PictureExchange::letIn() {
    const auto stopped = [this] {
        const std::lock_guard lock(mutex_);
        return stop_;
    };
    while (!stopped()) {
        auto connection = listener_->accept(Deadline::inMs(kAcceptSliceMs));
        if (!connection) continue;
        const auto find = [&](const std::string& name) {
            return nameOf(name).value_or(own_).rank != own_.rank ? std::optional(secret_) : std::nullopt;
        };
        auto shown =
            SecureConnection::accepting(std::move(*connection), find, Deadline::inMs(kProofPatienceMs), stopped);
        if (!shown) continue;
        const Name name = *nameOf((*shown)->name());
        add(name, std::move(*shown), Side::Accepted);
    }
}

Result<PictureExchange::Peer*> PictureExchange::peerOf(int rank, Deadline deadline) {
    std::unique_lock lock(mutex_);
    Peer& peer = peers_[rank];
    while (!peer.link.connection && !peer.gone) {
        const bool hadToConnectBefore = rank < own_.rank || own_.incarnation > 0;
        if (hadToConnectBefore || deadline.passed()) {
            peer.gone = true;
            return Error{"no connection from " + rangeText(rank) + " came"};
        }
        arrived_.wait_for(lock, std::chrono::milliseconds(kAcceptSliceMs));
    }
    if (peer.gone) return Error{rangeText(rank) + " is disconnected"};
    return &peer;
}

void PictureExchange::giveUp(int rank) {
    const std::lock_guard lock(mutex_);
    Peer& peer = peers_[rank];
    peer.gone = true;
    log::debug(log::Topic::Exchange, "gives up ", rangeText(rank));
    if (peer.link.connection) peer.link.connection->close();
}

Result<void> PictureExchange::send(int rank, std::vector<std::byte> message, Deadline deadline) {
    auto peer = peerOf(rank, deadline);
    if (!peer) return peer.error();
    bytesSent_ += message.size();
    auto sent = (*peer)->link.sender->send(std::move(message), deadline);
    if (sent) return sent;
    giveUp(rank);
    return Error{rangeText(rank) + ": " + sent.error().message};
}

Result<std::vector<std::byte>> PictureExchange::receive(int rank, size_t maxBytes, Deadline deadline) {
    auto peer = peerOf(rank, deadline);
    if (!peer) return peer.error();
    const auto take = [&](Connection& c) -> Result<std::vector<std::byte>> {
        std::array<std::byte, 4> size;
        if (auto r = c.read(size, deadline); !r) return r.error();
        const size_t bytes = loadLittle<uint32_t>(size.data());
        if (bytes > maxBytes)
            return Error{"the size of a picture, " + std::to_string(bytes) + " bytes, exceeds the limit of " +
                         std::to_string(maxBytes)};
        std::vector<std::byte> message(bytes);
        if (auto r = c.read(message, deadline); !r) return r.error();
        return message;
    };
    auto message = take(*(*peer)->link.connection);
    if (message) return message;
    giveUp(rank);
    return Error{rangeText(rank) + ": " + message.error().message};
}

LinkTransfer PictureExchange::takeTransfer(int rank) {
    const std::lock_guard lock(mutex_);
    const auto peer = peers_.find(rank);
    return peer == peers_.end() || !peer->second.link.sender ? LinkTransfer{}
                                                             : peer->second.link.sender->takeTransfer();
}

} // namespace mural
