#include "transport/connect.hpp"

#include "transport/connection_description.hpp"
#include "transport/plugin/plugin_connection.hpp"
#include "transport/plugin/plugin_library.hpp"
#include "transport/rsp/group_connection.hpp"
#include "transport/rsp/group_description.hpp"

namespace mural {

namespace {
using Kind = ConnectionDescription::Kind;

Error useless(std::string_view text, const std::string& why) {
    return Error{"connection \"" + std::string(text) + "\": " + why};
}
} // namespace

Result<std::unique_ptr<Connection>> connectTo(std::string_view text, Deadline deadline) {
    const auto parsed = parseConnectionDescription(text);
    if (!parsed) return parsed.error();
    const ConnectionDescription& to = parsed.value();
    switch (to.kind) {
    case Kind::Tcp:
        if (to.host.empty() || to.port == 0) return useless(text, "a connection needs a host and a port");
        return connectTcp(to.host, to.port, deadline);
    case Kind::SharedMemory:
        if (to.descriptor >= 0) return openSharedMemory(to.descriptor);
        break;
    case Kind::Rsp: {
        auto options = rsp::groupOptionsOf(to);
        if (!options) return options.error();
        if (!to.parameters.contains("control"))
            return useless(text, "a member needs control=HOST:PORT, the address of the group's host");
        return rsp::joinGroup(*options, deadline);
    }
    case Kind::Plugin: {
        const auto plugin = openPlugin(to.scheme);
        if (!plugin) return plugin.error();
        return connectByPlugin(*plugin.value(), std::string(text), deadline);
    }
    case Kind::Pipe: break;
    }
    return useless(
        text, "has no peer to connect to; use tcp://host:port, shm:descriptor or rsp://group:port?control=host:port");
}

Result<std::unique_ptr<Listener>> listenAt(std::string_view text) {
    const auto parsed = parseConnectionDescription(text);
    if (!parsed) return parsed.error();
    const ConnectionDescription& at = parsed.value();
    if (at.kind == Kind::Tcp) return listenTcp(at.host, at.port);
    if (at.kind == Kind::Plugin) {
        const auto plugin = openPlugin(at.scheme);
        if (!plugin) return plugin.error();
        return listenByPlugin(*plugin.value(), std::string(text));
    }
    if (at.kind != Kind::Rsp) return useless(text, "cannot be listened on; use tcp://host:port or rsp://group:port");
    auto options = rsp::groupOptionsOf(at);
    if (!options) return options.error();
    return rsp::hostGroup(*options);
}

} // namespace mural
