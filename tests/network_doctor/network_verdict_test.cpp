// Each fault causes one line of the verdict, and a network without faults causes none.
#include "tools/mural/network/network_verdict.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace mural::cli {
namespace {

constexpr size_t kMiB = size_t{1} << 20;

MachineFacts goodCard() {
    MachineFacts f;
    f.interface = "eth0";
    f.mtuBytes = 1500;
    f.linkBytesPerS = 125e6;
    f.multicast = true;
    f.bufferBytes = 8 * kMiB;
    return f;
}

HereMeasured here() { return {"0.1.0", goodCard(), "239.255.77.85:4277", 28, 1472}; }

HostMeasured goodHost() {
    HostMeasured h;
    h.host = "wall1";
    h.version = "0.1.0";
    h.reached = "10.0.0.1";
    h.own = "10.0.0.2";
    h.interfaceTowards = "eth0";
    h.facts = goodCard();
    for (PathMeasured& path : h.paths) path = {true, true, true, 1472, {}};
    h.multicast = true;
    h.datagrams = 100'000;
    h.bytesPerS = 100e6;
    return h;
}

void breakWay(HostMeasured& h, ProbePath path) { h.path(path) = {}; }

// Returns the only check that is not ok; an empty check if there are more or none.
Check fault(const HereMeasured& here, const HostMeasured& h) {
    std::vector<Check> bad = judgeHost(here, h);
    std::erase_if(bad, [](const Check& c) { return c.health == Health::Ok; });
    return bad.size() == 1 ? bad.front() : Check{Health::Ok, std::to_string(bad.size()) + " faults", {}, {}};
}
Check fault(const HostMeasured& h) { return fault(here(), h); }

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(NetworkVerdict, reportsNoFaultOfAGoodNetwork) {
    for (const Check& c : judgeHost(here(), goodHost())) EXPECT_EQ(c.health, Health::Ok) << c.name << ": " << c.found;
    for (const Check& c : judgeHere(here())) EXPECT_EQ(c.health, Health::Ok) << c.name << ": " << c.found;
}

TEST(NetworkVerdict, reportsThatOnlyTheGroupIsMissing) {
    HostMeasured h = goodHost();
    breakWay(h, ProbePath::Group);
    h.multicast = false;
    const Check c = fault(h);
    EXPECT_EQ(c.health, Health::Bad);
    EXPECT_TRUE(has(c.found, "snoops IGMP")) << c.found;
    EXPECT_TRUE(has(c.advice, "querier")) << c.advice;
    h.facts.silentBridges = {"br0"};
    EXPECT_TRUE(has(fault(h).advice, "`ip link set dev br0 type bridge mcast_querier 1`"));
}

TEST(NetworkVerdict, reportsMissingMulticast) {
    HostMeasured h = goodHost();
    breakWay(h, ProbePath::Group);
    breakWay(h, ProbePath::LinkLocal);
    h.multicast = false;
    EXPECT_TRUE(has(fault(h).found, "no multicast arrives")) << fault(h).found;
    EXPECT_FALSE(has(fault(h).advice, "rp_filter"));
    h.facts.strictReturnPath = true;
    EXPECT_TRUE(has(fault(h).advice, "rp_filter=2"));
    h.path(ProbePath::Group).trouble = "cannot send datagrams of 24 bytes: Operation not permitted";
    EXPECT_TRUE(has(fault(h).advice, "nft list ruleset"));
    h.interfaceTowards = "eth1";
    EXPECT_EQ(fault(h).advice, "add --interface eth1");
}

TEST(NetworkVerdict, reportsMulticastThatStops) {
    HostMeasured h = goodHost();
    h.path(ProbePath::Group).toLater = false;
    EXPECT_TRUE(has(fault(h).found, "arrived at first")) << fault(h).found;
}

TEST(NetworkVerdict, reportsAOneWayNetwork) {
    HostMeasured h = goodHost();
    h.path(ProbePath::Group).from = false;
    EXPECT_EQ(fault(h).health, Health::Warn);
}

TEST(NetworkVerdict, reportsMissingUdp) {
    HostMeasured h = goodHost();
    for (const ProbePath path : kProbePaths) breakWay(h, path);
    h.multicast = false;
    EXPECT_EQ(fault(h).name, "wall1: datagrams");
    EXPECT_TRUE(has(fault(h).found, "either direction"));
}

TEST(NetworkVerdict, reportsShorterPackets) {
    HereMeasured long9000 = here();
    long9000.facts.mtuBytes = 9000;
    long9000.cardBytes = 8972;
    const Check card = fault(long9000, goodHost());
    EXPECT_EQ(card.name, "wall1: datagram size");
    EXPECT_TRUE(has(card.advice, "`ip link set dev eth0 mtu 9000` there")) << card.advice;
    HostMeasured h = goodHost();
    h.facts.mtuBytes = 9000;
    EXPECT_TRUE(has(fault(long9000, h).found, "something between them")) << fault(long9000, h).found;
    EXPECT_TRUE(has(fault(long9000, h).advice, "mtu 1500")) << fault(long9000, h).advice;
}

TEST(NetworkVerdict, reportsLosses) {
    HostMeasured h = goodHost();
    h.lostShare = 0.0005;
    EXPECT_TRUE(has(fault(h).name, "0 faults"));
    h.lostShare = 0.005;
    EXPECT_EQ(fault(h).health, Health::Warn);
    h.lostShare = 0.05;
    EXPECT_EQ(fault(h).health, Health::Bad);
    h.queueDropped = 900;
    EXPECT_TRUE(has(fault(h).advice, "netdev_max_backlog"));
    h.lostShare = 0;
    EXPECT_TRUE(has(fault(h).name, "0 faults"));
    h.droppedShare = 0.05;
    EXPECT_TRUE(has(fault(h).found, "its socket"));
}

TEST(NetworkVerdict, reportsSmallBuffersAndSlowCards) {
    HostMeasured h = goodHost();
    h.facts.bufferBytes = 212'992;
    EXPECT_TRUE(has(fault(h).advice, "net.core.rmem_max=8388608")) << fault(h).advice;
    h = goodHost();
    h.facts.linkBytesPerS = 12.5e6;
    EXPECT_TRUE(has(fault(h).advice, "ethtool eth0"));
    h = goodHost();
    h.facts.multicast = false;
    EXPECT_EQ(fault(h).health, Health::Bad);
}

TEST(NetworkVerdict, reportsUnavailableFacts) {
    HostMeasured h = goodHost();
    h.failure = "it ended: exit status 255";
    EXPECT_EQ(fault(h).name, "wall1: start");
    h = goodHost();
    h.reached.clear();
    h.unreachedWhy = "10.0.0.1: Connection timed out";
    EXPECT_TRUE(has(fault(h).found, "Connection timed out"));
    h = goodHost();
    h.version = "9";
    EXPECT_EQ(fault(h).name, "wall1: version");
    h = goodHost();
    h.streamFailure = "it could not join the group";
    EXPECT_EQ(fault(h).name, "wall1: stream");
}

TEST(NetworkVerdict, reportsASnoopingBridgeWithoutQuerier) {
    HereMeasured h = here();
    h.facts.silentBridges = {"br0"};
    const auto checks = judgeHere(h);
    EXPECT_TRUE(
        std::ranges::any_of(checks, [](const Check& c) { return c.health == Health::Warn && c.name == "bridge br0"; }));
}

} // namespace
} // namespace mural::cli
