// A machine's network properties according to its kernel.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "transport/rsp/io/network_interface.hpp"

namespace mural::cli {

struct MachineFacts {
    std::string interface;
    size_t mtuBytes = 0;
    double linkBytesPerS = 0; // 0: unknown
    bool multicast = false;
    bool loopback = false;
    size_t bufferBytes = 0;                                    // granted receive buffer
    std::optional<uint64_t> receiveLimitBytes, sendLimitBytes; // net.core.rmem_max, wmem_max
    bool strictReturnPath = false; // rp_filter: drops packets whose source is reached through another interface
    std::vector<std::string> silentBridges; // bridges with IGMP snooping and no querier
};

// `root` precedes /proc and /sys, for tests.
MachineFacts readMachineFacts(const rsp::NetworkInterface& interface, size_t bufferBytes, const std::string& root = "");

// Returns the packets dropped by the kernel's input queues since boot, over all interfaces.
uint64_t droppedByQueues(const std::string& root = "");

nlohmann::json toJson(const MachineFacts& facts);
// Missing or mistyped fields keep their defaults.
MachineFacts machineFactsFrom(const nlohmann::json& json);

} // namespace mural::cli
