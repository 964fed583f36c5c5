// Selects libfabric providers and addresses for fabric://host:port?provider=NAME.
#pragma once

#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "transport/connection_description.hpp"
#include "transport/fabric/fabric_handle.hpp"

namespace mural::fabric {

enum class Role { Connect, Listen };

// Returns the matches, best first according to libfabric; never empty. Connection-oriented endpoints only.
Result<std::vector<Info>> findProviders(const ConnectionDescription& description, Role role, Deadline deadline);

Result<SharedFabric> openFabric(const fi_info& info);

// Returns "fabric://host:port?provider=tcp".
std::string fabricText(const std::string& host, uint16_t port, const std::string& provider);
// The same for a libfabric address; `otherwise` if it is not an IP address.
std::string fabricText(const void* address, size_t sizeBytes, const std::string& provider,
                       const std::string& otherwise);
std::string providerOf(const fi_info& info);

} // namespace mural::fabric
