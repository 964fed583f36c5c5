// Results of `mural doctor --network` for one host.
#pragma once

#include <array>
#include <string>

#include "tools/mural/network/machine_facts.hpp"
#include "tools/mural/network/probe_datagram.hpp"

namespace mural::cli {

struct PathMeasured {
    bool to = false;         // small datagrams arrive at the host
    bool from = false;       // small datagrams arrive from the host
    bool toLater = false;    // at the end of the survey
    size_t largestBytes = 0; // largest UDP payload that arrives at the host
    std::string trouble;     // error at either end
};

struct HostMeasured {
    std::string host;
    std::string failure; // reason why the host could not be surveyed; empty: none
    std::string version;
    std::string reached, own, unreachedWhy; // of the TCP connection from the host
    std::string interfaceTowards;           // interface of this machine; empty: unknown
    MachineFacts facts;
    std::array<PathMeasured, std::size(kProbePaths)> paths;
    bool hasStream = true;     // false: no stream is tried
    std::string streamFailure; // empty: the stream was measured
    bool multicast = false;    // the stream used multicast, not the member's connection
    uint64_t datagrams = 0;
    double bytesPerS = 0;
    double lostShare = 0;      // in the network
    double droppedShare = 0;   // by the host's socket
    uint64_t queueDropped = 0; // packets dropped by the host's kernel before a socket

    [[nodiscard]] const PathMeasured& path(ProbePath w) const { return paths[static_cast<size_t>(w)]; }
    [[nodiscard]] PathMeasured& path(ProbePath w) { return paths[static_cast<size_t>(w)]; }
};

// Results for the doctor's own machine.
struct HereMeasured {
    std::string version;
    MachineFacts facts;
    std::string group;       // address and port
    size_t headerBytes = 28; // IP and UDP headers
    size_t cardBytes = 0;    // largest UDP payload without fragmentation, as RSP uses it
};

} // namespace mural::cli
