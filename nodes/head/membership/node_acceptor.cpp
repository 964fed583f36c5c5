#include "nodes/head/membership/node_acceptor.hpp"

#include <charconv>
#include <poll.h>
#include <string>

#include "common/log/log.hpp"
#include "transport/secure/secure_connection.hpp"

namespace mural {
namespace {

constexpr int64_t kAcceptSliceMs = 100;
constexpr int64_t kProofPatienceMs = 5000;
const std::string kName = "node";
constexpr int kMaxChecked = 256; // limit of concurrent unauthenticated connections

int portOf(const std::string& description) {
    const size_t colon = description.rfind(':');
    int port = 0;
    if (colon != std::string::npos)
        std::from_chars(description.data() + colon + 1, description.data() + description.size(), port);
    return port;
}

} // namespace

std::string NodeAcceptor::nameOf(int node) { return kName + std::to_string(node); }

std::optional<int> NodeAcceptor::nodeOf(const std::string& name) {
    int node = -1;
    const char* const end = name.data() + name.size();
    if (!name.starts_with(kName)) return {};
    const auto [stop, code] = std::from_chars(name.data() + kName.size(), end, node);
    if (code != std::errc() || stop != end || node < 0) return {};
    return node;
}

Result<std::unique_ptr<NodeAcceptor>> NodeAcceptor::open(bool loopbackOnly) {
    auto listener = listenTcp(loopbackOnly ? "127.0.0.1" : "", 0);
    if (!listener) return listener.error();
    const int port = portOf((*listener)->describe());
    return std::unique_ptr<NodeAcceptor>(new NodeAcceptor(std::move(*listener), port));
}

NodeAcceptor::NodeAcceptor(std::unique_ptr<Listener> listener, int port)
    : listener_(std::move(listener)), port_(port), thread_([this] { acceptAll(); }) {}

NodeAcceptor::~NodeAcceptor() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
}

void NodeAcceptor::expect(int node, const SessionSecret& secret) {
    const std::lock_guard lock(mutex_);
    expected_[nameOf(node)] = {node, secret};
}

std::unique_ptr<Connection> NodeAcceptor::take(int node) {
    const std::lock_guard lock(mutex_);
    const auto found = arrived_.find(node);
    if (found == arrived_.end()) return nullptr;
    auto connection = std::move(found->second);
    arrived_.erase(found);
    return connection;
}

void NodeAcceptor::acceptAll() {
    while (!stop_) {
        const int64_t beganNs = monotonicNowNs();
        auto connection = listener_->accept(Deadline::inMs(kAcceptSliceMs));
        if (connection) {
            if (checking_ >= kMaxChecked) continue; // destroys the connection
            ++checking_;
            checkers_.emplace_back([this, c = std::move(*connection)]() mutable {
                check(std::move(c));
                --checking_;
            });
        } else if (monotonicNowNs() - beganNs < kAcceptSliceMs * kNsPerMs / 2) {
            poll(nullptr, 0, static_cast<int>(kAcceptSliceMs)); // out of descriptors: avoids a busy loop
        }
    }
    for (auto& checker : checkers_) checker.join();
}

std::optional<SessionSecret> NodeAcceptor::secretOf(const std::string& name) {
    const std::lock_guard lock(mutex_);
    const auto found = expected_.find(name);
    if (found == expected_.end()) return {};
    return found->second.second;
}

void NodeAcceptor::check(std::unique_ptr<Connection> connection) {
    auto shown = SecureConnection::accepting(
        std::move(connection), [this](const std::string& name) { return secretOf(name); },
        Deadline::inMs(kProofPatienceMs), [this] { return stop_.load(); });
    if (!shown) return log::debug(log::Topic::Node, "a connection was refused: ", shown.error().message);
    const std::lock_guard lock(mutex_);
    const auto found = expected_.find((*shown)->name());
    if (found == expected_.end()) return; // each secret admits one connection
    log::debug(log::Topic::Node, "node ", found->second.first, " has connected");
    arrived_[found->second.first] = std::move(*shown);
    expected_.erase(found);
}

} // namespace mural
