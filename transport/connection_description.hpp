// Description of a connection as text: on command lines, in configurations, between processes.
//   pipe:              both ends in this process
//   shm:               shared memory, not offered yet;  shm:7  the offer inherited as descriptor 7
//   tcp://host:port    TCP; IPv6 addresses in brackets
//   rsp://group:port?parameter=value&...   a multicast group; parameters: transport/rsp/group_description.hpp
//   scheme://host:port?parameter=value&... any other scheme: the plug-in of that name
//   (transport/plugin/transport_plugin.h)
// transport/connect.hpp connects and listens with such a text.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace mural {

struct ConnectionDescription {
    enum class Kind { Pipe, SharedMemory, Tcp, Rsp, Plugin };

    Kind kind = Kind::Pipe;
    std::string host;    // without brackets; empty: all addresses, for listening only. rsp: the group's address
    uint16_t port = 0;   // all but pipe and shm; 0: any free port, for listening
    int descriptor = -1; // shm
    std::map<std::string, std::string> parameters{}; // rsp, plug-ins
    std::string scheme{};                            // plug-ins: a to z, 0 to 9

    friend bool operator==(const ConnectionDescription&, const ConnectionDescription&) = default;
};

Result<ConnectionDescription> parseConnectionDescription(std::string_view text);
std::string toText(const ConnectionDescription& description);

} // namespace mural
