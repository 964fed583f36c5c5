// One request of a client of the control interface: a line of JSON. Pure.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace mural {

struct ControlRequest {
    nlohmann::json id; // a whole number; null: the line has no valid one
    std::string operation;
    nlohmann::json arguments = nlohmann::json::object();
    std::string problem; // why the line is no request; empty: it is one
};

inline constexpr int kMaxControlDepth = 16; // copies of deeper values need much stack

// Returns the depth of nested brackets outside of strings. Accepts any bytes.
int depthOfJson(std::string_view line);

// Parses {"id": 1, "op": "status", "args": {}}. Accepts any bytes.
ControlRequest parseControlRequest(std::string_view line);

} // namespace mural
