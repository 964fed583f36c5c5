// What `mural doctor --network` has measured of one host.
#pragma once

#include <array>
#include <string>

#include "tools/mural/network/machine_facts.hpp"
#include "tools/mural/network/probe_datagram.hpp"

namespace mural::cli {

struct WayMeasured {
    bool to = false;    // small datagrams arrive there
    bool from = false;  // and here
    bool toLater = false; // at the end of it all
    size_t largestBytes = 0; // UDP payload, on the way there
    std::string trouble;     // here, or there
};

struct HostMeasured {
    std::string host;
    std::string failure; // it could not be looked at; empty: it was
    std::string version;
    std::string reached, own, unreachedWhy; // by TCP, from there
    std::string interfaceTowards;           // here; empty: not known
    MachineFacts facts;
    std::array<WayMeasured, std::size(kProbeWays)> ways;
    std::string streamFailure; // empty: there was a stream
    bool multicast = false;    // the stream came so, not by the member's connection
    uint64_t datagrams = 0;
    double bytesPerS = 0;
    double lostShare = 0;    // on the way
    double droppedShare = 0; // by the host's own socket
    uint64_t queueDropped = 0; // packets, by the host's kernel before they came to a socket

    [[nodiscard]] const WayMeasured& way(ProbeWay w) const { return ways[static_cast<size_t>(w)]; }
    [[nodiscard]] WayMeasured& way(ProbeWay w) { return ways[static_cast<size_t>(w)]; }
};

// The doctor's own machine.
struct HereMeasured {
    std::string version;
    MachineFacts facts;
    std::string group; // address and port
    size_t headerBytes = 28; // IP's and UDP's
    size_t cardBytes = 0; // UDP payload that goes out whole: as RSP uses it
};

} // namespace mural::cli
