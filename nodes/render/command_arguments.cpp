#include "nodes/render/command_arguments.hpp"

#include <nlohmann/json.hpp>

namespace mural {

std::optional<HostPort> addressIn(const nlohmann::json& all, const char* what, int node, const std::string& headHost) {
    const auto found = all.is_object() ? all.find(what) : all.end();
    if (found == all.end() || !found->is_object()) return std::nullopt;
    auto where = splitHostPort(found->value(std::to_string(node), ""));
    if (!where) return std::nullopt;
    if (where->host.empty()) where->host = headHost.empty() ? "127.0.0.1" : headHost;
    return *where;
}

} // namespace mural
