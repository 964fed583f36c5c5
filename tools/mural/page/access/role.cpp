#include "tools/mural/page/access/role.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace mural::page {

namespace {

constexpr std::array<std::string_view, 3> kRoleNames = {"view", "input", "operate"};
constexpr std::array<std::string_view, 10> kReading = {"help",       "status",      "nodes",   "report", "frames",
                                                       "equalizers", "unsubscribe", "preview", "wall",   "outputs"};
// Without arguments these return a setting, and with arguments they change it.
constexpr std::array<std::string_view, 5> kSettings = {"latency", "overlay", "layout", "plan", "log-level"};
constexpr std::array<std::string_view, 2> kLease = {"input-take", "input-release"};

template <size_t count> bool isIn(const std::array<std::string_view, count>& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

// Log lines contain host names, paths and command lines.
bool subscribesToLog(const nlohmann::json& arguments) {
    if (!arguments.is_object()) return false;
    const auto topic = arguments.find("topic");
    return topic != arguments.end() && topic->is_string() && topic->get_ref<const std::string&>() == "log";
}

} // namespace

std::string_view nameOf(Role role) { return kRoleNames[static_cast<size_t>(role)]; }

std::optional<Role> roleOfName(std::string_view name) {
    const auto found = std::ranges::find(kRoleNames, name);
    if (found == kRoleNames.end()) return std::nullopt;
    return static_cast<Role>(found - kRoleNames.begin());
}

Role requiredRole(std::string_view operation, const nlohmann::json& arguments) {
    if (isIn(kReading, operation)) return Role::View;
    if (operation == "subscribe") return subscribesToLog(arguments) ? Role::Operate : Role::View;
    if (isIn(kSettings, operation)) return arguments.empty() ? Role::View : Role::Operate;
    if (isIn(kLease, operation)) return Role::Input;
    return Role::Operate;
}

} // namespace mural::page
