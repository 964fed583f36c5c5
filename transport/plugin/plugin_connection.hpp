// Wraps connections and listeners of a plug-in (transport_plugin.h) as Mural's own.
#pragma once

#include <memory>
#include <string>

#include "transport/connection.hpp"
#include "transport/plugin/transport_plugin.h"

namespace mural {

Result<std::unique_ptr<Connection>> connectByPlugin(const mural_transport_plugin& plugin,
                                                    const std::string& description, Deadline deadline);
Result<std::unique_ptr<Listener>> listenByPlugin(const mural_transport_plugin& plugin, const std::string& description);

} // namespace mural
