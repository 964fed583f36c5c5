// Finding and opening the plug-in of a scheme (transport_plugin.h).
#pragma once

#include <string>

#include "common/result.hpp"
#include "transport/plugin/transport_plugin.h"

namespace mural {

// Where Mural's own libraries lie: from the program's file, as in build folders and where it is installed.
std::string pluginFolder();

// Opens FOLDER/libmural_transport_SCHEME.so; it stays open, for its threads may outlive its connections. Errors: it is not
// there or can't be loaded, is no plug-in, is one of another version or scheme.
Result<const mural_transport_plugin*> openPlugin(const std::string& scheme, const std::string& folder = pluginFolder());

} // namespace mural
