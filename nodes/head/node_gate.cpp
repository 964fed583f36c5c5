#include "nodes/head/node_gate.hpp"

#include <charconv>
#include <poll.h>
#include <string>

namespace mural {
namespace {

constexpr int64_t kAcceptSliceMs = 100;
constexpr int64_t kProofPatienceMs = 5000;
constexpr int kMostChecked = 32; // strangers that keep silent at the same time

int portOf(const std::string& description) {
    const size_t colon = description.rfind(':');
    int port = 0;
    if (colon != std::string::npos)
        std::from_chars(description.data() + colon + 1, description.data() + description.size(), port);
    return port;
}

} // namespace

Result<std::unique_ptr<NodeGate>> NodeGate::open(bool loopbackOnly) {
    auto listener = listenTcp(loopbackOnly ? "127.0.0.1" : "0.0.0.0", 0);
    if (!listener) return listener.error();
    const int port = portOf((*listener)->describe());
    return std::unique_ptr<NodeGate>(new NodeGate(std::move(*listener), port));
}

NodeGate::NodeGate(std::unique_ptr<Listener> listener, int port)
    : listener_(std::move(listener))
    , port_(port)
    , thread_([this] { acceptAll(); }) {}

NodeGate::~NodeGate() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
}

void NodeGate::expect(int node, const SessionSecret& secret) {
    const std::lock_guard lock(mutex_);
    expected_[node] = secret;
}

std::unique_ptr<Connection> NodeGate::take(int node) {
    const std::lock_guard lock(mutex_);
    const auto found = arrived_.find(node);
    if (found == arrived_.end()) return nullptr;
    auto connection = std::move(found->second);
    arrived_.erase(found);
    return connection;
}

void NodeGate::acceptAll() {
    while (!stop_) {
        const int64_t beganNs = monotonicNowNs();
        auto connection = listener_->accept(Deadline::inMs(kAcceptSliceMs));
        if (connection) {
            if (checking_ >= kMostChecked) continue; // closes it
            ++checking_;
            checkers_.emplace_back([this, c = std::move(*connection)]() mutable {
                check(std::move(c));
                --checking_;
            });
        } else if (monotonicNowNs() - beganNs < kAcceptSliceMs * kNsPerMs / 2) {
            poll(nullptr, 0, static_cast<int>(kAcceptSliceMs)); // out of descriptors: not in a busy loop
        }
    }
    for (auto& checker : checkers_) checker.join();
}

void NodeGate::check(std::unique_ptr<Connection> connection) {
    SessionSecret shown{};
    const Deadline deadline = Deadline::inMs(kProofPatienceMs);
    Result<void> got = Error{};
    while (!got && !deadline.passed() && !stop_) {
        got = connection->read(shown, Deadline::inMs(kAcceptSliceMs));
        if (!got && !connection->timedOut()) return;
    }
    if (!got) return;
    const std::lock_guard lock(mutex_);
    int node = -1;
    for (const auto& [candidate, secret] : expected_)
        if (sameSecret(secret, shown)) node = candidate;
    if (node < 0) return;
    expected_.erase(node); // good for one connection
    arrived_[node] = std::move(connection);
}

} // namespace mural
