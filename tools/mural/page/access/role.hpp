// The roles of the page's viewers, and the role that an operation requires. Pure.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>

namespace mural::page {

// Each role includes those before it.
enum class Role : uint8_t {
    View,   // pictures and state
    Input,  // and input to the program
    Operate // and every operation, links, log lines, configuration
};

[[nodiscard]] std::string_view nameOf(Role role);
[[nodiscard]] std::optional<Role> roleOfName(std::string_view name);

// Returns the least role that may request the operation with these arguments. Operations that this page does not know
// require Operate, because a later head may have them.
[[nodiscard]] Role requiredRole(std::string_view operation, const nlohmann::json& arguments);

} // namespace mural::page
