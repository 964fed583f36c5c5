// What a machine's kernel says about the network that Mural would use there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "transport/rsp/network_interface.hpp"

namespace mural::cli {

struct MachineFacts {
    std::string interface;
    size_t mtuBytes = 0;
    double linkBytesPerS = 0; // 0: the card does not tell
    bool multicast = false;
    bool loopback = false;
    size_t bufferBytes = 0; // that a socket got for receiving
    std::optional<uint64_t> receiveLimitBytes, sendLimitBytes; // net.core.rmem_max, wmem_max
    bool strictReturnPath = false; // rp_filter: what comes from an address that is reached by another interface is dropped
    std::vector<std::string> silentBridges; // that snoop, and are no querier themselves
};

// `root` stands before /proc and /sys, for tests.
MachineFacts readMachineFacts(const rsp::NetworkInterface& interface, size_t bufferBytes, const std::string& root = "");

// Packets that the kernel's queues between cards and sockets had no room for since the machine began, all cards together.
uint64_t droppedByQueues(const std::string& root = "");

nlohmann::json toJson(const MachineFacts& facts);
// What is missing or of another kind stays as it is by default.
MachineFacts machineFactsFrom(const nlohmann::json& json);

} // namespace mural::cli
