// Looks up the names of a configuration and completes it, in the order of Equalizer's loader: resources, displays and
// their destination channels, compounds; then compounds for what nothing draws, canvases for what nothing shows, an
// observer where there is none, and what files of the versions before 1.1 and 1.2 mean.
#pragma once

#include "balancer/config/diagnostics.hpp"
#include "balancer/config/global_attributes.hpp"
#include "balancer/config/resolved_config.hpp"

namespace mural::config {

// With errors (diagnostics.errors() > 0) the result is not for use.
ResolvedConfig resolve(const ConfigFile& file, const Globals& environment, Diagnostics& diagnostics);

} // namespace mural::config
