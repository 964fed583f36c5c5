// The socket end of the control interface: a Unix socket of a running session, and a thread that serves its clients.
//
// A client never blocks the session: the thread waits for no client, and rests after each turn in which a client used
// its whole share.
#pragma once

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "nodes/head/control/control_feed.hpp"
#include "nodes/head/control/control_operations.hpp"
#include "nodes/head/control/control_protocol.hpp"

namespace mural {

inline constexpr size_t kMaxControlClients = 32;
inline constexpr size_t kControlRequestsPerTurn = 64; // per client

struct ControlServerConfig {
    std::string path;         // of the socket; it gets mode 600
    nlohmann::json hello;     // members of the first line to each client
    int64_t stallMs = 10'000; // a client that reads nothing for this time loses its connection
};

class ControlServer {
public:
    // The server's thread calls the operations. `feed` must outlive the server.
    static Result<std::unique_ptr<ControlServer>> start(ControlServerConfig config, ControlOperations operations,
                                                        ControlFeed& feed);
    ControlServer(const ControlServer&) = delete;
    ControlServer& operator=(const ControlServer&) = delete;
    ~ControlServer(); // sends what the sockets accept at once, and removes the socket

private:
    struct Client {
        FileDescriptor socket;
        std::unique_ptr<ControlProtocol> protocol;
        Deadline stalledAt = Deadline::never(); // set while bytes wait for the client
        bool inputEnded = false;
        bool isGone = false;
    };

    ControlServer(ControlServerConfig config, FileDescriptor listener, ControlOperations operations, ControlFeed& feed);
    void serve();
    void waitForClients();
    [[nodiscard]] int timeoutMs() const;
    void acceptOne();
    void turn();
    void performShare(Client& client, int64_t nowNs);
    void distribute();
    void updateFeed();
    void receive(Client& client);
    void send(Client& client);
    [[nodiscard]] static bool isFinished(const Client& client);

    const ControlServerConfig config_;
    const FileDescriptor listener_;
    const ControlOperations operations_;
    ControlFeed& feed_;
    std::vector<Client> clients_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace mural
