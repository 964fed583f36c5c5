// Pictures from node to node, without the head in between. Of two nodes the one with the higher rank connects to the other.
// Connections are encrypted, by a secret that the head has given to the nodes of this picture alone.
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "nodes/exchange/part_routes.hpp"
#include "transport/connection.hpp"
#include "transport/secure_channel.hpp"

namespace mural {

class PictureExchange final : public PartRoutes {
public:
    // rank: of this node, from 0 on.
    PictureExchange(int rank, const ChannelSecret& secret) : rank_(rank), secret_(secret) {}
    ~PictureExchange() override;

    // Lets nodes of higher ranks in, on a free port: port(). By a thread of its own. loopbackOnly: all of them run on this machine.
    Result<void> listen(bool loopbackOnly);
    [[nodiscard]] uint16_t port() const { return port_; }
    // To a node of a lower rank.
    Result<void> connectTo(int rank, const std::string& host, uint16_t port, Deadline deadline);

    // By the thread that replays.
    Result<void> send(int rank, std::vector<std::byte> message, Deadline deadline) override;
    Result<std::vector<std::byte>> receive(int rank, size_t mostBytes, Deadline deadline) override;
    LinkTransfer takeTransfer(int rank) override;
    void giveUp(int rank) override;

    // Of messages, to all.
    [[nodiscard]] uint64_t bytesSent() const { return bytesSent_; }

    // What a node of that rank calls itself when it connects, and back; 0: it is no such name.
    [[nodiscard]] static std::string nameOf(int rank);
    [[nodiscard]] static int rankOf(const std::string& name);

private:
    struct Peer {
        std::unique_ptr<Connection> connection;
        std::unique_ptr<PartSender> sender; // ends before its connection
        bool gone = false;
    };
    void letIn();
    void add(int rank, std::unique_ptr<Connection> connection);
    Result<Peer*> peerOf(int rank, Deadline deadline);

    const int rank_;
    const ChannelSecret secret_;
    std::unique_ptr<Listener> listener_;
    uint16_t port_ = 0;
    std::thread thread_;
    std::mutex mutex_;
    std::condition_variable arrived_;
    bool stop_ = false;
    uint64_t bytesSent_ = 0;
    std::map<int, Peer> peers_; // by rank; they stay where they are
};

} // namespace mural
