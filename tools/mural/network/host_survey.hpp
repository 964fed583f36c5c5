// Surveys one host: reachability, largest datagram, and a stream.
#pragma once

#include "tools/mural/network/host_measured.hpp"
#include "tools/mural/network/probe_process.hpp"
#include "tools/mural/network/probe_sockets.hpp"
#include "transport/rsp/group.hpp"

namespace mural::cli {

struct SurveyPlan {
    rsp::GroupOptions group; // options of the host role
    size_t headerBytes = 28; // IP and UDP headers
    size_t cardBytes = 0;    // largest UDP payload of this machine's interface
    double seconds = 1;
};

class HostSurvey {
public:
    HostSurvey(const SurveyPlan& plan, ProbeSockets& sockets, ProbeProcess& process, HostMeasured& into)
        : plan_(plan), sockets_(sockets), process_(process), m_(into) {}

    // Reads the first reply, sent after start-up.
    Result<void> greet(Deadline deadline);
    Result<void> measure();
    // Measures all but the stream.
    Result<void> probe();
    // Checks again that multicast arrives.
    Result<void> probeAgain();

private:
    Result<void> probeThere(const std::vector<size_t>& sizes, const std::vector<ProbePath>& paths);
    Result<void> probeBack();
    Result<void> findLargest(ProbePath path);
    Result<void> stream();
    Result<void> streamTo(rsp::Group& group);

    const SurveyPlan& plan_;
    ProbeSockets& sockets_;
    ProbeProcess& process_;
    HostMeasured& m_;
    SocketAddress single_; // the host's unicast socket
    size_t seenBytes_ = 0; // largest arrival of the last probes with the current method
};

} // namespace mural::cli
