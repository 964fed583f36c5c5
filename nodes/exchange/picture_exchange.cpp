#include "nodes/exchange/picture_exchange.hpp"

#include <array>
#include <charconv>
#include <chrono>

#include "common/little_endian.hpp"
#include "transport/free_port.hpp"
#include "transport/secure_connection.hpp"

namespace mural {

namespace {

const std::string kName = "range";
constexpr int64_t kAcceptSliceMs = 100;
constexpr int64_t kProofPatienceMs = 5000;

std::string rangeText(int rank) { return "range " + std::to_string(rank + 1); }

} // namespace

std::string PictureExchange::nameOf(int rank) { return kName + std::to_string(rank); }

int PictureExchange::rankOf(const std::string& name) {
    int rank = 0;
    if (!name.starts_with(kName)) return 0;
    const auto [end, error] = std::from_chars(name.data() + kName.size(), name.data() + name.size(), rank);
    return error == std::errc() && end == name.data() + name.size() ? rank : 0;
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
    auto secure = SecureConnection::connecting(std::move(*connection), nameOf(rank_), secret_, deadline);
    if (!secure) return secure.error();
    add(rank, std::move(*secure));
    return {};
}

PictureExchange::~PictureExchange() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    if (thread_.joinable()) thread_.join();
}

void PictureExchange::add(int rank, std::unique_ptr<Connection> connection) {
    const std::lock_guard lock(mutex_);
    Peer& peer = peers_[rank];
    if (peer.connection || peer.gone) return; // the first one counts
    peer.connection = std::move(connection);
    peer.sender = std::make_unique<PartSender>(*peer.connection);
    arrived_.notify_all();
}

void PictureExchange::letIn() {
    const auto stopped = [this] {
        const std::lock_guard lock(mutex_);
        return stop_;
    };
    while (!stopped()) {
        auto connection = listener_->accept(Deadline::inMs(kAcceptSliceMs));
        if (!connection) continue;
        const auto find = [&](const std::string& name) { return rankOf(name) > rank_ ? std::optional(secret_) : std::nullopt; };
        auto shown = SecureConnection::accepting(std::move(*connection), find, Deadline::inMs(kProofPatienceMs), stopped);
        if (!shown) continue;
        const int rank = rankOf((*shown)->name());
        add(rank, std::move(*shown));
    }
}

Result<PictureExchange::Peer*> PictureExchange::peerOf(int rank, Deadline deadline) {
    std::unique_lock lock(mutex_);
    Peer& peer = peers_[rank];
    while (!peer.connection && !peer.gone) {
        if (rank < rank_) peer.gone = true; // it was to be connected to before
        else if (deadline.passed()) peer.gone = true;
        else {
            arrived_.wait_for(lock, std::chrono::milliseconds(kAcceptSliceMs));
            continue;
        }
        return Error{"no connection of " + rangeText(rank) + " came"};
    }
    if (peer.gone) return Error{rangeText(rank) + " is gone"};
    return &peer;
}

void PictureExchange::giveUp(int rank) {
    const std::lock_guard lock(mutex_);
    Peer& peer = peers_[rank];
    peer.gone = true;
    if (peer.connection) peer.connection->close();
}

Result<void> PictureExchange::send(int rank, std::vector<std::byte> message, Deadline deadline) {
    auto peer = peerOf(rank, deadline);
    if (!peer) return peer.error();
    bytesSent_ += message.size();
    auto sent = (*peer)->sender->send(std::move(message), deadline);
    if (sent) return sent;
    giveUp(rank);
    return Error{rangeText(rank) + ": " + sent.error().message};
}

Result<std::vector<std::byte>> PictureExchange::receive(int rank, size_t mostBytes, Deadline deadline) {
    auto peer = peerOf(rank, deadline);
    if (!peer) return peer.error();
    const auto take = [&](Connection& c) -> Result<std::vector<std::byte>> {
        std::array<std::byte, 4> size;
        if (auto r = c.read(size, deadline); !r) return r.error();
        const size_t bytes = loadLittle<uint32_t>(size.data());
        if (bytes > mostBytes) return Error{"a picture of " + std::to_string(bytes) + " bytes came where " + std::to_string(mostBytes) + " are the most"};
        std::vector<std::byte> message(bytes);
        if (auto r = c.read(message, deadline); !r) return r.error();
        return message;
    };
    auto message = take(*(*peer)->connection);
    if (message) return message;
    giveUp(rank);
    return Error{rangeText(rank) + ": " + message.error().message};
}

LinkTransfer PictureExchange::takeTransfer(int rank) {
    const std::lock_guard lock(mutex_);
    const auto peer = peers_.find(rank);
    return peer == peers_.end() || !peer->second.sender ? LinkTransfer{} : peer->second.sender->takeTransfer();
}

} // namespace mural
