// Accepts encrypted TCP connections of render nodes. A peer that does not prove the secret of its node name is
// disconnected before any of its other data is read.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "nodes/session/session_secret.hpp"
#include "transport/connection.hpp"

namespace mural {

// Thread-safe.
class NodeAcceptor {
public:
    // Listens on a free port, on the loopback interface or on all interfaces.
    static Result<std::unique_ptr<NodeAcceptor>> open(bool loopbackOnly);
    NodeAcceptor(const NodeAcceptor&) = delete;
    NodeAcceptor& operator=(const NodeAcceptor&) = delete;
    ~NodeAcceptor();

    [[nodiscard]] int port() const { return port_; }
    void expect(int node, const SessionSecret& secret);
    std::unique_ptr<Connection> take(int node); // null: not connected yet
    static std::string nameOf(int node);        // the name by which a node identifies itself
    static std::optional<int> nodeOf(const std::string& name);

private:
    NodeAcceptor(std::unique_ptr<Listener> listener, int port);
    void acceptAll();
    void check(std::unique_ptr<Connection> connection);
    std::optional<SessionSecret> secretOf(const std::string& name);

    const std::unique_ptr<Listener> listener_;
    const int port_;
    std::atomic<bool> stop_{false};
    std::mutex mutex_;
    std::map<std::string, std::pair<int, SessionSecret>> expected_; // by name
    std::map<int, std::unique_ptr<Connection>> arrived_;
    std::atomic<int> checking_{0};
    std::vector<std::thread> checkers_; // owned by the accepting thread
    std::thread thread_;
};

} // namespace mural
