// Direct picture exchange between nodes. Of two nodes that start together, the one with the higher rank connects; a
// restarted node connects to all peers. The accepting node confirms each connection, so that no node waits for one that
// will not come. A node that lags in the stream still reads the messages of a lost node; the incarnation
// distinguishes them from its successor's. Connections are encrypted with a secret that the head gives to the nodes of
// one picture.
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
#include "transport/secure/secure_channel.hpp"

namespace mural {

class PictureExchange final : public PartRoutes {
public:
    struct Name {
        int rank = 0;             // from 0
        uint32_t incarnation = 0; // number of restarts
        friend bool operator==(const Name&, const Name&) = default;
    };
    PictureExchange(Name own, const ChannelSecret& secret) : own_(own), secret_(secret) {}
    ~PictureExchange() override;

    // Accepts other ranks on a free port, port(), on its own thread. loopbackOnly: all nodes run on this machine.
    Result<void> listen(bool loopbackOnly);
    [[nodiscard]] uint16_t port() const { return port_; }
    // Connects to a listening node. Returns when the peer has confirmed.
    Result<void> connectTo(int rank, const std::string& host, uint16_t port, Deadline deadline);

    // Call from the replay thread.
    Result<void> send(int rank, std::vector<std::byte> message, Deadline deadline) override;
    Result<std::vector<std::byte>> receive(int rank, size_t maxBytes, Deadline deadline) override;
    LinkTransfer takeTransfer(int rank) override;
    void giveUp(int rank) override;
    void renew(int rank, uint32_t incarnation) override;

    // Total size of messages to all peers.
    [[nodiscard]] uint64_t bytesSent() const { return bytesSent_; }

    // Formats and parses the name with which a node connects. The parser returns nothing for an invalid name.
    [[nodiscard]] static std::string textOf(const Name& name);
    [[nodiscard]] static std::optional<Name> nameOf(const std::string& text);

private:
    struct Link {
        std::unique_ptr<Connection> connection;
        std::unique_ptr<PartSender> sender; // destroyed before its connection
        uint32_t incarnation = 0;           // incarnation of the peer
        void end();
    };
    struct Peer {
        Link link;
        std::map<uint32_t, Link> next; // connections of restarted peers by incarnation, until renew()
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
    std::map<int, Peer> peers_; // by rank; entries keep their addresses
};

} // namespace mural
