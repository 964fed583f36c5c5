#include "nodes/head/control/control_server.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/ipc/user_socket.hpp"
#include "common/json/json_text.hpp"
#include "common/log/log.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

constexpr int kSliceMs = 50; // entries of the feed wait no longer
constexpr int kIdleMs = 500; // without subscriptions
constexpr int kBacklog = 16;
constexpr size_t kReceiveBytes = size_t{16} << 10;
constexpr int64_t kRestRatio = 3;             // rest after a full turn: this multiple of its duration…
constexpr int64_t kMaxRestNs = 50 * kNsPerMs; // …up to this time

bool isTemporary(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

void refuse(int socket) {
    const std::string line =
        jsonText(Json{{"id", nullptr},
                      {"ok", false},
                      {"code", control_code::kLimit},
                      {"error", "the session has " + std::to_string(kMaxControlClients) +
                                    " control clients already; end one of them, such as mural stat --watch"}}) +
        "\n";
    [[maybe_unused]] const ssize_t n = ::send(socket, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

} // namespace

Result<std::unique_ptr<ControlServer>> ControlServer::start(ControlServerConfig config, ControlOperations operations,
                                                            ControlFeed& feed) {
    auto listener = listenForUser(config.path, SOCK_STREAM, kBacklog);
    if (!listener)
        return Error{"the control socket " + config.path + " cannot be opened: " + listener.error().message +
                     "; mural stat and mural ctl do not find this session; set XDG_RUNTIME_DIR to a short, writable "
                     "folder"};
    std::unique_ptr<ControlServer> server(
        new ControlServer(std::move(config), std::move(*listener), std::move(operations), feed));
    server->thread_ = std::thread([raw = server.get()] { raw->serve(); });
    return server;
}

ControlServer::ControlServer(ControlServerConfig config, FileDescriptor listener, ControlOperations operations,
                             ControlFeed& feed)
    : config_(std::move(config)), listener_(std::move(listener)), operations_(std::move(operations)), feed_(feed) {}

ControlServer::~ControlServer() {
    stop_ = true;
    shutdown(listener_.get(), SHUT_RDWR); // wakes the thread
    if (thread_.joinable()) thread_.join();
    unlink(config_.path.c_str());
}

void ControlServer::serve() {
    while (!stop_) {
        waitForClients();
        if (stop_) break;
        const int64_t beganNs = monotonicNowNs();
        turn();
        const bool isFull = std::ranges::any_of(clients_, [](const Client& c) { return c.protocol->hasRequest(); });
        if (!isFull) continue;
        const int64_t nowNs = monotonicNowNs();
        sleepUntilNs(nowNs + std::min(kRestRatio * (nowNs - beganNs), kMaxRestNs));
    }
    distribute();
    for (Client& client : clients_) {
        client.protocol->sendMessages(INT64_MAX / 2); // also those that are not due
        send(client);
    }
    clients_.clear();
}

int ControlServer::timeoutMs() const {
    const bool isFed = feed_.isWanted(ControlTopic::Log) || feed_.isWanted(ControlTopic::Events);
    int64_t untilNs = (isFed ? kSliceMs : kIdleMs) * kNsPerMs;
    const int64_t nowNs = monotonicNowNs();
    for (const Client& client : clients_) {
        if (client.protocol->hasRequest()) return 0;
        untilNs = std::clamp(client.protocol->nextMessageNs() - nowNs, int64_t{0}, untilNs);
    }
    return static_cast<int>((untilNs + kNsPerMs - 1) / kNsPerMs);
}

void ControlServer::waitForClients() {
    std::vector<pollfd> polled{{listener_.get(), POLLIN, 0}};
    for (const Client& client : clients_) {
        pollfd& entry = polled.emplace_back(pollfd{client.socket.get(), 0, 0});
        if (!client.inputEnded && client.protocol->acceptsBytes()) entry.events |= POLLIN;
        if (!client.protocol->unsent().empty()) entry.events |= POLLOUT;
    }
    if (poll(polled.data(), polled.size(), timeoutMs()) <= 0) return;
    for (size_t i = 0; i < clients_.size(); ++i) {
        const short events = polled[i + 1].revents;
        // The peer has closed both directions. Its last requests are still read.
        if ((events & (POLLHUP | POLLERR | POLLNVAL)) != 0 && (events & POLLIN) == 0) clients_[i].isGone = true;
        if ((events & POLLIN) != 0) receive(clients_[i]);
    }
    if (polled[0].revents != 0 && !stop_) acceptOne();
}

void ControlServer::acceptOne() {
    FileDescriptor socket(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    // Waits, because without a free descriptor the next accept4() would fail at once.
    if (!socket.valid() && (errno == EMFILE || errno == ENFILE)) poll(nullptr, 0, kSliceMs);
    if (!socket.valid() || !isPeerOwnOrRoot(socket.get())) return;
    if (clients_.size() >= kMaxControlClients) return refuse(socket.get());
    Client& client = clients_.emplace_back();
    client.socket = std::move(socket);
    client.protocol = std::make_unique<ControlProtocol>(operations_, config_.hello);
}

void ControlServer::receive(Client& client) {
    char bytes[kReceiveBytes];
    const ssize_t n = recv(client.socket.get(), bytes, sizeof bytes, MSG_DONTWAIT);
    if (n > 0) client.protocol->receive({bytes, static_cast<size_t>(n)});
    if (n == 0) client.inputEnded = true; // replies to earlier requests are still sent
    if (n < 0 && !isTemporary(errno)) client.isGone = true;
}

// Every client performs its share of requests, then sends.
void ControlServer::turn() {
    const int64_t nowNs = monotonicNowNs();
    for (Client& client : clients_) performShare(client, nowNs);
    distribute();
    for (Client& client : clients_) {
        client.protocol->sendMessages(nowNs);
        send(client);
    }
    std::erase_if(clients_, isFinished);
}

// A subscription has effect before the next request, whose events it includes.
void ControlServer::performShare(Client& client, int64_t nowNs) {
    for (size_t i = 0; i < kControlRequestsPerTurn && client.protocol->hasRequest(); ++i) {
        client.protocol->perform(1, nowNs);
        updateFeed();
    }
}

// Passes log lines and events to the clients that subscribe to them.
void ControlServer::distribute() {
    const ControlFeed::Batch batch = feed_.take();
    for (Client& client : clients_) {
        for (const ControlFeed::Entry& entry : batch.entries) client.protocol->offer(entry.topic, entry.json);
        for (size_t i = 0; i < kControlTopics; ++i)
            client.protocol->countDropped(static_cast<ControlTopic>(i), batch.dropped[i]);
    }
    updateFeed(); // clients may have left
}

void ControlServer::updateFeed() {
    for (size_t i = 0; i < kControlTopics; ++i) {
        const auto topic = static_cast<ControlTopic>(i);
        feed_.setWanted(topic, std::ranges::any_of(clients_, [topic](const Client& client) {
                            return client.protocol->subscribes(topic);
                        }));
    }
}

void ControlServer::send(Client& client) {
    const std::string_view unsent = client.protocol->unsent();
    if (unsent.empty() || client.isGone) return;
    const ssize_t n = ::send(client.socket.get(), unsent.data(), unsent.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n < 0 && !isTemporary(errno)) client.isGone = true;
    if (n > 0) client.protocol->sent(static_cast<size_t>(n));
    if (client.protocol->unsent().empty())
        client.stalledAt = Deadline::never();
    else if (n > 0 || client.stalledAt.atNs() == INT64_MAX)
        client.stalledAt = Deadline::inMs(config_.stallMs);
    if (!client.stalledAt.passed()) return;
    log::debug(log::Topic::Session, "a control client that reads nothing loses its connection");
    client.isGone = true;
}

bool ControlServer::isFinished(const Client& client) {
    const bool isAnswered = client.protocol->unsent().empty() && !client.protocol->hasRequest();
    return client.isGone || (isAnswered && (client.inputEnded || client.protocol->isOver()));
}

} // namespace mural
