// A node that waits for heads without ssh: `mural node --wait`. Whoever shows that he knows the secret has this machine run
// Mural's node process, and only that; its standard input, output and errors travel over the connection, and it ends with it.
// One head at a time: while one has nodes here, others are sent away.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "common/result.hpp"
#include "transport/file_descriptor.hpp"
#include "transport/secure_channel.hpp"

namespace mural {

struct WaitingOptions {
    std::string listen = ":4279"; // address, or none for all; port, 0: any
    ChannelSecret secret{};
    std::string executable; // what orders run
    std::function<void(const std::string&)> log;
};

class WaitingNode {
public:
    static Result<std::unique_ptr<WaitingNode>> open(const WaitingOptions& options);

    [[nodiscard]] uint16_t port() const { return port_; }
    // Serves until `stopFd` is readable. Errors: nobody can be listened to any longer.
    Result<void> serve(int stopFd);

private:
    WaitingNode(WaitingOptions options, FileDescriptor socket, uint16_t port) : options_(std::move(options)), socket_(std::move(socket)), port_(port) {}
    void take(FileDescriptor socket, const std::string& peer);
    bool enter(const std::string& peer);
    void leave(const std::string& peer);
    void say(const std::string& line);

    WaitingOptions options_;
    FileDescriptor socket_;
    uint16_t port_;
    std::mutex mutex_;
    std::map<std::string, unsigned> heads_; // orders that run, by the head's address: one entry at most
    std::atomic<unsigned> connections_ = 0;
    std::atomic<bool> stop_ = false;
};

} // namespace mural
