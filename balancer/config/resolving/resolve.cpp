#include "balancer/config/resolve.hpp"

#include "balancer/config/resolving/resolver.hpp"

namespace mural::config {

ResolvedConfig resolve(const ConfigFile& file, const Globals& environment, Diagnostics& diagnostics) {
    Resolver r{file, GlobalDefaults(file.globals, environment), diagnostics, {}};
    resolveResources(r);
    resolveDisplays(r);
    resolveCompounds(r);
    if (diagnostics.errors() > 0) return std::move(r.out); // references are missing: stop here
    linkChannels(r.out);
    useShownChannels(r);
    addOutputCompounds(r);
    linkChannels(r.out);
    addDestinationViews(r);
    addDefaultObserver(r);
    mendVersion10(r);
    mendVersion11(r);
    addTileQueues(r);
    addCopies(r);
    nameFrames(r);
    return std::move(r.out);
}

} // namespace mural::config
