#include "transport/fabric/fabric_connect.hpp"

#include "transport/fabric/fabric_connection.hpp"
#include "transport/fabric/fabric_provider.hpp"

namespace mural::fabric {

namespace {

Result<std::unique_ptr<Connection>> connectBy(fi_info& info, const ConnectionDescription& to, Deadline deadline) {
    const auto fabric = openFabric(info);
    if (!fabric) return fabric.error();
    const std::string text = fabricText(to.host, to.port, providerOf(info));
    auto endpoint = Endpoint::open(fabric.value(), info);
    if (!endpoint) return Error{text + ": " + endpoint.error().message};
    const auto greeting = (*endpoint)->connect(deadline);
    if (!greeting) return Error{text + ": " + greeting.error().message};
    return std::unique_ptr<Connection>(
        std::make_unique<FabricConnection>(std::move(*endpoint), greeting.value(), text));
}

} // namespace

// Divides the remaining time among providers and addresses. Reports the first error, which belongs to the best
// provider.
Result<std::unique_ptr<Connection>> connectFabric(const ConnectionDescription& to, Deadline deadline) {
    if (to.host.empty() || to.port == 0) return Error{toText(to) + ": a connection needs a host and a port"};
    auto providers = findProviders(to, Role::Connect, deadline);
    if (!providers) return providers.error();
    Error first;
    for (size_t i = 0; i < providers->size(); ++i) {
        const auto remaining = static_cast<int64_t>(providers->size() - i);
        const int64_t shareMs = deadline.leftNs(3600 * kNsPerS) / kNsPerMs / remaining;
        auto made = connectBy(*(*providers)[i], to, remaining == 1 ? deadline : Deadline::inMs(shareMs));
        if (made) return made;
        if (i == 0) first = made.error();
        if (deadline.passed()) break;
    }
    return first;
}

} // namespace mural::fabric
