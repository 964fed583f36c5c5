// Pictures from node to node, without the head in between. Of two nodes that start together the one with the higher rank connects to
// the other; one that comes back connects to all that it needs. Who connects hears when the other has its connection, so that nobody
// waits for one that will not come. A node that is behind in the stream still reads of one that was lost what that had sent: what its
// successors send is told apart by their `life`. Connections are encrypted, by a secret that the head has given to the nodes of this
// picture alone.
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "nodes/exchange/part_routes.hpp"
#include "transport/connection.hpp"
#include "transport/secure_channel.hpp"

namespace mural {

class PictureExchange final : public PartRoutes {
public:
    struct Name {
        int rank = 0;      // from 0 on
        uint32_t life = 0; // how often the node of that rank was started again
        friend bool operator==(const Name&, const Name&) = default;
    };
    PictureExchange(Name own, const ChannelSecret& secret) : own_(own), secret_(secret) {}
    ~PictureExchange() override;

    // Lets nodes of other ranks in, on a free port: port(). By a thread of its own, until the end. loopbackOnly: all of them run on this machine.
    Result<void> listen(bool loopbackOnly);
    [[nodiscard]] uint16_t port() const { return port_; }
    // To a node that listens. Back when that one has the connection.
    Result<void> connectTo(int rank, const std::string& host, uint16_t port, Deadline deadline);

    // By the thread that replays.
    Result<void> send(int rank, std::vector<std::byte> message, Deadline deadline) override;
    Result<std::vector<std::byte>> receive(int rank, size_t mostBytes, Deadline deadline) override;
    LinkTransfer takeTransfer(int rank) override;
    void giveUp(int rank) override;
    void renew(int rank, uint32_t life) override;

    // Of messages, to all.
    [[nodiscard]] uint64_t bytesSent() const { return bytesSent_; }

    // What a node calls itself when it connects, and back; nothing: it is no such name.
    [[nodiscard]] static std::string textOf(const Name& name);
    [[nodiscard]] static std::optional<Name> nameOf(const std::string& text);

private:
    struct Link {
        std::unique_ptr<Connection> connection;
        std::unique_ptr<PartSender> sender; // ends before its connection
        uint32_t life = 0; // of the other end
        void end();
    };
    struct Peer {
        Link link;
        std::map<uint32_t, Link> next; // of nodes that have come back, by life, until renew()
        bool gone = false;
    };
    enum class Side { Accepted, Connected };
    void letIn();
    void add(const Name& name, std::unique_ptr<Connection> connection, Side side);
    Result<Peer*> peerOf(int rank, Deadline deadline);

    const Name own_;
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
