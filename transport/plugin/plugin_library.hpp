// Finds and opens the plug-in of a scheme (transport_plugin.h).
#pragma once

#include <string>

#include "common/base/result.hpp"
#include "transport/plugin/transport_plugin.h"

namespace mural {

// Returns the folder of Mural's libraries, relative to the program's file: in build folders and after installation.
std::string pluginFolder();

// Opens FOLDER/libmural_transport_SCHEME.so. It is never closed, because its threads may outlive its connections.
// Errors: missing or not loadable, not a plug-in, another version or scheme.
Result<const mural_transport_plugin*> openPlugin(const std::string& scheme, const std::string& folder = pluginFolder());

} // namespace mural
