// Logs losses, repairs and rate changes of a group: topic rsp, level debug. Compares the counters of the protocol at
// intervals, so the protocol itself logs nothing.
#pragma once

#include <cstdint>
#include <map>

#include "transport/rsp/protocol/group_core.hpp"

namespace mural::rsp {

class GroupDiagnostics {
public:
    // Call after each tick of the core, with the group's lock. Costs one load while the topic is off.
    void look(GroupCore& core, int64_t nowNs);

private:
    struct Losses {
        uint32_t lost = 0, dropped = 0;
    };
    void compareSender(const Sender& sender);
    void compareMember(MemberId id, const MemberState& member);
    void compareReceiver(MemberId from, const Receiver& receiver);

    int64_t nextNs_ = INT64_MIN; // time of the next comparison
    SenderCounters sent_;
    double bytesPerS_ = 0;                       // last reported rate
    std::map<MemberId, Losses> reported_;        // by members, of this process's stream
    std::map<MemberId, uint32_t> missed_;        // by this process, of the members' streams
    std::map<MemberId, uint64_t> reconstructed_; // the same, restored from parity
};

} // namespace mural::rsp
