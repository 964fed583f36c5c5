// One host's part of a survey: what arrives, how long it may be, and a stream.
#pragma once

#include "tools/mural/network/host_measured.hpp"
#include "tools/mural/network/probe_process.hpp"
#include "tools/mural/network/probe_sockets.hpp"
#include "transport/rsp/group.hpp"

namespace mural::cli {

struct SurveyPlan {
    rsp::GroupOptions group; // as its host
    size_t headerBytes = 28; // IP's and UDP's
    size_t cardBytes = 0; // UDP payload of our card's packets
    double seconds = 1;
};

class HostSurvey {
public:
    HostSurvey(const SurveyPlan& plan, ProbeSockets& sockets, ProbeProcess& process, HostMeasured& into)
        : plan_(plan), sockets_(sockets), process_(process), m_(into) {}

    // Its first answer, which comes when it has started.
    Result<void> greet(Deadline deadline);
    Result<void> measure();
    // Whether the group is still heard there.
    Result<void> lookAgain();

private:
    Result<void> probeThere(const std::vector<size_t>& sizes, const std::vector<ProbeWay>& ways);
    Result<void> probeBack();
    Result<void> findLargest(ProbeWay way);
    Result<void> stream();
    Result<void> streamTo(rsp::Group& group);

    const SurveyPlan& plan_;
    ProbeSockets& sockets_;
    ProbeProcess& process_;
    HostMeasured& m_;
    SocketAddress single_; // its own socket
    size_t seenBytes_ = 0; // the largest of the last probes of the way that is looked at
};

} // namespace mural::cli
