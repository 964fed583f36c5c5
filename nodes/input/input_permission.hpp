// Whether events of windows reach the program (--window-input, and input= of --send).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace mural::input {

enum class InputPermission : uint8_t {
    Off,
    Private, // if the program runs on a private display
    Any      // also on a display of the user, whose pointer then moves
};

inline constexpr std::pair<InputPermission, const char*> kInputPermissions[] = {
    {InputPermission::Off, "off"}, {InputPermission::Private, "on"}, {InputPermission::Any, "display"}};
inline constexpr const char* kInputPermissionNames = "off, on or display"; // for messages

[[nodiscard]] constexpr std::optional<InputPermission> inputPermissionOf(std::string_view name) {
    for (const auto& [permission, text] : kInputPermissions)
        if (name == text) return permission;
    return std::nullopt;
}

} // namespace mural::input
