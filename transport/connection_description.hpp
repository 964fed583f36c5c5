// Where a connection leads, as text: on command lines, in configurations, between processes.
//   pipe:              both ends in this process
//   shm:               shared memory, not yet offered;  shm:7  the offer inherited as descriptor 7
//   tcp://host:port    TCP; IPv6 numbers in brackets
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "transport/connection.hpp"

namespace mural {

struct ConnectionDescription {
    enum class Kind { Pipe, SharedMemory, Tcp };

    Kind kind = Kind::Pipe;
    std::string host;    // tcp, without brackets; empty only for listening: every address
    uint16_t port = 0;   // tcp; 0: any free one, for listening
    int descriptor = -1; // shm

    friend bool operator==(const ConnectionDescription&, const ConnectionDescription&) = default;
};

Result<ConnectionDescription> parseConnectionDescription(std::string_view text);
std::string toText(const ConnectionDescription& description);

// Connects to where the text leads: tcp://… or shm:N.
Result<std::unique_ptr<Connection>> connectTo(std::string_view text, Deadline deadline);
// Listens where the text says: tcp://host:port.
Result<std::unique_ptr<Listener>> listenAt(std::string_view text);

} // namespace mural
