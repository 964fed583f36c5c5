// Diagnostics of a group on a simulated network: they report losses and repairs, and only while the topic is on.
#include "transport/rsp/io/group_diagnostics.hpp"

#include <gtest/gtest.h>

#include "tests/recorded_log.hpp"
#include "tests/transport/rsp/simulated_group.hpp"

namespace mural::rsp::test {
namespace {

// Writes to one member, whose datagrams are lost at that rate. Returns the diagnostics of the host and of the member.
std::string diagnosticsOf(double loss, const char* levels) {
    SimulatedGroup group(9, [](GroupSettings& s) { s.rate.maxBytesPerS = 20e6; });
    const size_t member = group.join();
    EXPECT_TRUE(group.run(kNsPerS, [&] { return group.allLive(); }));
    group.network.faults(member).loss = loss;
    const RecordedLog log(levels);
    GroupDiagnostics ofHost, ofMember;
    group.processes[0].write(4 << 20);
    const auto look = [&] {
        ofHost.look(group.processes[0].core, group.network.nowNs());
        ofMember.look(group.processes[member].core, group.network.nowNs());
        return group.processes[0].written == 4 << 20 && group.allRead();
    };
    EXPECT_TRUE(group.run(20 * kNsPerS, look));
    group.run(kNsPerS, [&] { return look() && false; }); // the last changes
    EXPECT_EQ(group.wrongBytes(), 0u);
    return log.text();
}

TEST(GroupDiagnostics, reportLossesRepairsAndTheRate) {
    const std::string lines = diagnosticsOf(0.03, "rsp:debug");
    for (const char* part : {"for repair, ", "member 1 reports ", "stream of member 0: ", "rate 0.00 -> "})
        EXPECT_NE(lines.find(part), std::string::npos) << "no \"" << part << "\" in:\n" << lines;
}

TEST(GroupDiagnostics, reportOnlyTheRateWithoutLosses) {
    const std::string lines = diagnosticsOf(0, "rsp:debug");
    EXPECT_TRUE(lines.starts_with("rate 0.00 -> 20.00 MB/s")) << lines; // of the host: the member sends nothing
    EXPECT_EQ(std::ranges::count(lines, '\n'), 1) << lines;
}

TEST(GroupDiagnostics, areSilentWhileTheTopicIsOff) { EXPECT_EQ(diagnosticsOf(0.03, "debug,rsp:info"), ""); }

} // namespace
} // namespace mural::rsp::test
