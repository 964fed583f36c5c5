// Surveys the network between this machine and hosts: starts all members at once, then measures them one after the
// other to avoid interference.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/base/result.hpp"
#include "tools/mural/network/host_measured.hpp"
#include "tools/mural/network/network_arguments.hpp"

namespace mural::cli {

struct Survey {
    HereMeasured here;
    std::vector<HostMeasured> hosts;
};

// Errors concern this machine: nothing could be measured. `progress` receives the current host.
Result<Survey> surveyNetwork(const NetworkArguments& arguments,
                             const std::function<void(const std::string& host)>& progress);

} // namespace mural::cli
