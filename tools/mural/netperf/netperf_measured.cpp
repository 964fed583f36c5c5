#include "tools/mural/netperf/netperf_measured.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"

namespace mural::cli {

using nlohmann::json;

void Timeline::add(uint64_t bytes, int64_t nowNs) {
    if (stepNs_ == 0) return;
    if (steps_.empty()) beganNs_ = nowNs;
    const auto step = static_cast<size_t>((nowNs - beganNs_) / stepNs_);
    if (steps_.size() <= step) steps_.resize(step + 1);
    steps_[step] += bytes;
}

double Measured::latencyUs(double share) const {
    if (latenciesUs.empty()) return 0;
    const auto at = static_cast<size_t>(share * static_cast<double>(latenciesUs.size()));
    return latenciesUs[std::min(at, latenciesUs.size() - 1)];
}

namespace {

double secondsOf(int64_t ns) { return static_cast<double>(ns) * 1e-9; }

json toJson(const Measured& m) {
    const rsp::SenderCounters& s = m.report.sender;
    json j{{"role", m.role},
           {"bytes", m.bytes},
           {"seconds", m.elapsedS},
           {"mbit", m.mbit()},
           {"cpuSeconds", m.cpuS},
           {"cpuSecondsPerGB", m.cpuPerGB()},
           {"datagrams", s.datagrams},
           {"parity", s.rows},
           {"resent", s.resent},
           {"polls", s.polls},
           {"feedback", s.feedback},
           {"sendings", m.report.sendings},
           {"sendingBy", m.report.sendingBy},
           {"socketDropped", m.report.socketDropped},
           {"rateMbit", m.report.bytesPerS * 8e-6},
           {"refused", m.report.refused.all()},
           {"replayed", m.report.refused.replayed},
           {"forged", m.report.refused.forged},
           {"membersLost", m.membersLost}};
    if (!m.cut.empty()) j["cut"] = m.cut;
    if (!m.wrong.empty()) j["wrong"] = m.wrong;
    if (m.joinedNs != 0) j["firstByte"] = m.beganAt;
    if (m.joinedNs != 0)
        j["join"] = {
            {"beganAt", secondsOf(m.joinBeganNs)}, {"joinedAt", secondsOf(m.joinedNs)}, {"seconds", m.joinS()}};
    if (!m.latenciesUs.empty()) {
        j["latencyUs"] = {{"p50", m.latencyUs(0.5)},
                          {"p90", m.latencyUs(0.9)},
                          {"p99", m.latencyUs(0.99)},
                          {"max", m.latenciesUs.back()},
                          {"count", m.latenciesUs.size()}};
    }
    if (m.timeline.stepNs() != 0) {
        j["timeline"] = {{"beganAt", secondsOf(m.timeline.beganNs())},
                         {"stepSeconds", secondsOf(m.timeline.stepNs())},
                         {"bytes", m.timeline.steps()}};
    }
    for (const auto& stream : m.report.streams) {
        j["streams"].push_back({{"from", stream.from},
                                {"datagrams", stream.received.datagrams},
                                {"recovered", stream.received.recovered},
                                {"duplicates", stream.received.duplicates},
                                {"lost", stream.lost},
                                {"feedback", stream.feedback}});
    }
    for (const auto& member : m.report.members) {
        j["members"].push_back({{"id", member.id},
                                {"address", member.info.address},
                                {"multicast", member.info.multicast},
                                {"roundTripUs", static_cast<double>(member.state.roundTripNs) * 1e-3},
                                {"lost", member.state.lost},
                                {"dropped", member.state.dropped}});
    }
    return j;
}

void printTable(const Measured& m) {
    const rsp::SenderCounters& s = m.report.sender;
    fmt::print("{}: {} bytes in {:.3f} s = {:.1f} Mbit/s, CPU {:.2f} s per GB\n", m.role, m.bytes, m.elapsedS, m.mbit(),
               m.cpuPerGB());
    if (m.joinedNs != 0) fmt::print("  joined within {:.1f} ms\n", m.joinS() * 1e3);
    if (!m.latenciesUs.empty()) {
        fmt::print("  latency to all receivers: p50 {:.0f} us, p90 {:.0f}, p99 {:.0f}, maximum {:.0f} ({} messages)\n",
                   m.latencyUs(0.5), m.latencyUs(0.9), m.latencyUs(0.99), m.latenciesUs.back(), m.latenciesUs.size());
    }
    if (s.datagrams > 0) {
        fmt::print("  {} datagrams in {} sends by {}; {} parity, {} retransmitted, {} polls, {} feedbacks\n",
                   s.datagrams, m.report.sendings, m.report.sendingBy, s.rows, s.resent, s.polls, s.feedback);
    }
    if (m.membersLost > 0) fmt::print("  {} receivers left before the end\n", m.membersLost);
    for (const auto& member : m.report.members) {
        fmt::print("  member {} at {}: {}, round trip {:.0f} us, lost {}, dropped by its socket {}\n", member.id,
                   member.info.address, member.info.multicast ? "multicast" : "through the host's connection",
                   static_cast<double>(member.state.roundTripNs) * 1e-3, member.state.lost, member.state.dropped);
    }
    for (const auto& stream : m.report.streams) {
        if (stream.received.datagrams == 0) continue;
        fmt::print("  {} datagrams, {} recovered from parity, {} duplicates, {} lost in the network\n",
                   stream.received.datagrams, stream.received.recovered, stream.received.duplicates, stream.lost);
    }
}

} // namespace

void print(const Measured& m, bool asJson) {
    if (asJson)
        fmt::print("{}\n", jsonText(toJson(m)));
    else
        printTable(m);
    std::fflush(stdout);
}

} // namespace mural::cli
