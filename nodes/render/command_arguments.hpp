// Reads the arguments of the head's commands: binary ones, and the addresses of an Exchange command.
#pragma once

#include <cstddef>
#include <cstring>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "transport/tcp/socket_address.hpp"

namespace mural {

// Returns the first bytes of a command's arguments as a T; empty: there are too few.
template <class T> std::optional<T> argument(std::span<const std::byte> bytes) {
    if (bytes.size() < sizeof(T)) return std::nullopt;
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

// Returns as many values as the bytes contain, without an incomplete last one.
template <class T> std::vector<T> argumentList(std::span<const std::byte> bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

// Returns the address at which `node` listens. `what`: member of the message. A node without a host runs on the head's
// machine, `headHost`; empty: this machine.
[[nodiscard]] std::optional<HostPort> addressIn(const nlohmann::json& all, const char* what, int node,
                                                const std::string& headHost);

} // namespace mural
