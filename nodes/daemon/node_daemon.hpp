// The daemon: `mural node --wait`. A peer that proves the secret can run Mural's node process here, and nothing else.
// Its standard streams travel on the connection, and it ends with the connection. One head at a time: others are
// refused while a head has nodes here.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural {

struct DaemonOptions {
    std::string listen = ":4279"; // address (empty: all interfaces) and port (0: any)
    ChannelSecret secret{};
    std::string executable; // the program that runs all commands: mural
};

class NodeDaemon {
public:
    static Result<std::unique_ptr<NodeDaemon>> open(const DaemonOptions& options);

    [[nodiscard]] uint16_t port() const { return port_; }
    // Serves until `stopFd` is readable. Errors: listening has failed.
    Result<void> serve(int stopFd);

private:
    NodeDaemon(DaemonOptions options, FileDescriptor socket, uint16_t port)
        : options_(std::move(options)), socket_(std::move(socket)), port_(port) {}
    void take(FileDescriptor socket, const std::string& peer);
    bool enter(const std::string& peer);
    void leave(const std::string& peer);

    DaemonOptions options_;
    FileDescriptor socket_;
    uint16_t port_;
    std::mutex mutex_;
    std::map<std::string, unsigned> heads_; // running commands by the head's address; at most one entry
    std::atomic<unsigned> connections_ = 0;
    std::atomic<bool> stop_ = false;
};

} // namespace mural
