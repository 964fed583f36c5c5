#include "nodes/exchange/picture_exchange.hpp"

#include <charconv>
#include <chrono>
#include <cstring>

#include "transport/connection_description.hpp"
#include "transport/secure_connection.hpp"

namespace mural {

namespace {

const std::string kName = "range";
constexpr int64_t kAcceptSliceMs = 100;
constexpr int64_t kProofPatienceMs = 5000;
constexpr uint64_t kMostPixels = uint64_t{1} << 28;

// As it crosses the network, little-endian.
struct Header {
    uint32_t client, window;
    uint64_t serial;
    int32_t x, y, w, h;
};
static_assert(sizeof(Header) == 32);

Result<void> readAll(Connection& c, void* into, size_t bytes, Deadline deadline) { return c.read({static_cast<std::byte*>(into), bytes}, deadline); }

} // namespace

int PictureExchange::rankOf(const std::string& name) {
    int rank = 0;
    if (!name.starts_with(kName)) return 0;
    const auto [end, error] = std::from_chars(name.data() + kName.size(), name.data() + name.size(), rank);
    return error == std::errc() && end == name.data() + name.size() ? rank : 0;
}

Result<std::unique_ptr<PictureExchange>> PictureExchange::collecting(const ChannelSecret& secret, bool loopbackOnly) {
    auto listener = listenTcp(loopbackOnly ? "127.0.0.1" : "", 0);
    if (!listener) return listener.error();
    auto where = parseConnectionDescription((*listener)->describe());
    if (!where) return where.error();
    std::unique_ptr<PictureExchange> exchange(new PictureExchange());
    exchange->port_ = where->port;
    exchange->listener_ = std::move(*listener);
    exchange->thread_ = std::thread([e = exchange.get(), secret] { e->letIn(secret); });
    return exchange;
}

Result<std::unique_ptr<PictureExchange>> PictureExchange::contributing(const std::string& host, uint16_t port, int rank, const ChannelSecret& secret, Deadline deadline) {
    auto connection = connectTcp(host, port, deadline);
    if (!connection) return connection.error();
    auto secure = SecureConnection::connecting(std::move(*connection), kName + std::to_string(rank), secret, deadline);
    if (!secure) return secure.error();
    std::unique_ptr<PictureExchange> exchange(new PictureExchange());
    exchange->connections_[0] = std::move(*secure);
    return exchange;
}

PictureExchange::~PictureExchange() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    if (thread_.joinable()) thread_.join();
}

void PictureExchange::letIn(const ChannelSecret& secret) {
    const auto stopped = [this] {
        const std::lock_guard lock(mutex_);
        return stop_;
    };
    while (!stopped()) {
        auto connection = listener_->accept(Deadline::inMs(kAcceptSliceMs));
        if (!connection) continue;
        const auto find = [&](const std::string& name) { return rankOf(name) > 0 ? std::optional(secret) : std::nullopt; };
        auto shown = SecureConnection::accepting(std::move(*connection), find, Deadline::inMs(kProofPatienceMs), stopped);
        if (!shown) continue;
        const int rank = rankOf((*shown)->name());
        const std::lock_guard lock(mutex_);
        connections_.try_emplace(rank, std::move(*shown)); // the first one counts
        arrived_.notify_all();
    }
}

Result<void> PictureExchange::send(const PicturePart& part, Deadline deadline) {
    std::unique_ptr<Connection>& connection = connections_[0];
    if (!connection) return Error{"the node that puts pictures together is gone"};
    const Header header{part.client, part.window, part.serial, part.box.x, part.box.y, part.box.w, part.box.h};
    auto done = connection->write(std::as_bytes(std::span(&header, 1)), deadline);
    if (done) done = connection->write(std::as_bytes(std::span(part.colour)), deadline);
    if (done) done = connection->write(std::as_bytes(std::span(part.depth)), deadline);
    if (done) connection->flush();
    else connection.reset();
    return done;
}

Result<PicturePart> PictureExchange::receive(int rank, Deadline deadline) {
    Connection* connection = nullptr;
    {
        std::unique_lock lock(mutex_);
        while (!connections_.contains(rank)) {
            if (deadline.passed()) {
                connections_[rank] = nullptr;
                return Error{"no connection of range " + std::to_string(rank + 1) + " came"};
            }
            arrived_.wait_for(lock, std::chrono::milliseconds(kAcceptSliceMs));
        }
        connection = connections_[rank].get();
    }
    if (!connection) return Error{"range " + std::to_string(rank + 1) + " is gone"};
    const auto take = [&]() -> Result<PicturePart> {
        Header header{};
        if (auto r = readAll(*connection, &header, sizeof header, deadline); !r) return r.error();
        PicturePart part;
        part.client = header.client;
        part.window = header.window;
        part.serial = header.serial;
        part.box = {header.x, header.y, header.w, header.h};
        if (header.w < 0 || header.h < 0 || uint64_t(header.w) * uint64_t(header.h) > kMostPixels) return Error{"a picture of no sensible size"};
        const auto pixels = static_cast<size_t>(header.w) * static_cast<size_t>(header.h);
        part.colour.resize(pixels);
        part.depth.resize(pixels);
        if (auto r = readAll(*connection, part.colour.data(), pixels * 4, deadline); !r) return r.error();
        if (auto r = readAll(*connection, part.depth.data(), pixels * 4, deadline); !r) return r.error();
        return part;
    };
    auto part = take();
    if (!part) {
        const std::lock_guard lock(mutex_);
        connections_[rank] = nullptr;
    }
    return part;
}

} // namespace mural
