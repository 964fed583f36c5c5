// Pictures from node to node, without the head in between: one collects, the others contribute. Connections are encrypted,
// by a secret that the head has given to the nodes of this picture alone.
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "nodes/exchange/picture_part.hpp"
#include "transport/connection.hpp"
#include "transport/secure_channel.hpp"

namespace mural {

class PictureExchange {
public:
    // Listens for contributors on a free port: port(). They are let in by a thread of its own.
    // loopbackOnly: all of them run on this machine.
    static Result<std::unique_ptr<PictureExchange>> collecting(const ChannelSecret& secret, bool loopbackOnly);
    // rank: of this contributor, from 1 on.
    static Result<std::unique_ptr<PictureExchange>> contributing(const std::string& host, uint16_t port, int rank, const ChannelSecret& secret, Deadline deadline);
    ~PictureExchange();

    [[nodiscard]] uint16_t port() const { return port_; }
    [[nodiscard]] static int rankOf(const std::string& name);

    // By the thread that replays. Errors: the other end is gone, or has not come by the deadline; said once, later
    // calls for the same end fail at once.
    Result<void> send(const PicturePart& part, Deadline deadline);
    // The next part of that contributor.
    Result<PicturePart> receive(int rank, Deadline deadline);

private:
    PictureExchange() = default;
    void letIn(const ChannelSecret& secret);

    std::unique_ptr<Listener> listener_;
    uint16_t port_ = 0;
    std::thread thread_;
    std::mutex mutex_;
    std::condition_variable arrived_;
    bool stop_ = false;
    std::map<int, std::unique_ptr<Connection>> connections_; // by rank; null: it is gone
};

} // namespace mural
