// Resolves the names of a configuration and completes it, in the order of Equalizer's loader: resources, displays and
// their destination channels, compounds. It then adds compounds for channels without one, canvases for channels without
// one, a default observer, and the meaning of files before versions 1.1 and 1.2.
#pragma once

#include "balancer/config/diagnostics.hpp"
#include "balancer/config/global_attributes.hpp"
#include "balancer/config/resolved_config.hpp"

namespace mural::config {

// After errors (diagnostics.errors() > 0) the result is unusable.
ResolvedConfig resolve(const ConfigFile& file, const Globals& environment, Diagnostics& diagnostics);

} // namespace mural::config
