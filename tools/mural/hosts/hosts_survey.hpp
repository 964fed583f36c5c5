// Examines hosts for `mural doctor --nodes`: one process per host, all at the same time, within 15 s.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "tools/mural/hosts/host_facts.hpp"
#include "tools/mural/network/host_measured.hpp"
#include "tools/mural/network/probe_rate.hpp"

namespace mural::cli {

struct ClockMeasured {
    bool measured = false;
    double offsetS = 0; // the host's time minus this machine's
    double errorS = 0;  // half of the shortest round trip
};

struct HostExamined {
    std::string host;
    std::string failure;     // the host could not be examined; empty: it was
    std::string failurePart; // part that failed, such as "GL and displays"; empty: all of it
    HostMeasured network;
    HostFacts machine;
    ClockMeasured clock;
    std::string portProblem; // reason why this machine cannot connect to the host; empty: it can
    RateMeasured toHost, fromHost;
};

struct HostsPlan {
    std::vector<std::string> hosts;
    std::string launchCommand, remoteMural;
    std::string group, interface;
    std::vector<InspectionPlan> inspections; // one per host
};

struct HostsSurvey {
    HereMeasured here;
    std::string build; // of this machine
    std::vector<HostExamined> hosts;
};

// Errors concern this machine: nothing could be examined.
Result<HostsSurvey> surveyHosts(const HostsPlan& plan);

} // namespace mural::cli
