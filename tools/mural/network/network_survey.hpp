// Measures the network between this machine and hosts: starts a member on each, all at once, then looks at one after the
// other, so that none disturbs another's figures.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/result.hpp"
#include "tools/mural/network/host_measured.hpp"
#include "tools/mural/network/network_arguments.hpp"

namespace mural::cli {

struct Survey {
    HereMeasured here;
    std::vector<HostMeasured> hosts;
};

// Errors are of this machine: nothing could be measured at all. `progress` is told the host that is looked at.
Result<Survey> surveyNetwork(const NetworkArguments& arguments, const std::function<void(const std::string& host)>& progress);

} // namespace mural::cli
