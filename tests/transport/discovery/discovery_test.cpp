// Announcement and discovery over this machine's own network, without Avahi, which may not run here.
#include "transport/discovery/announcing.hpp"

#include <algorithm>
#include <unistd.h>

#include <gtest/gtest.h>

namespace mural {
namespace {

const DiscoveryOptions kBeacon{true, false, {}};

Announcement self(const std::string& name) {
    Announcement a{AnnouncementKind::Here, 4278, {}, name + std::to_string(::getpid()), "0.1.0"};
    const auto pid = static_cast<uint32_t>(::getpid());
    std::copy_n(reinterpret_cast<const std::byte*>(&pid), sizeof pid, a.uuid.begin());
    a.uuid[15] = static_cast<std::byte>(name.size());
    return a;
}

bool has(const std::vector<FoundNode>& nodes, const Announcement& a) {
    return std::ranges::any_of(
        nodes, [&](const FoundNode& n) { return n.uuid == a.uuid && n.name == a.name && n.port == a.port; });
}

TEST(Discovery, findsANodeAtOnceAndDropsItAtOnce) {
    const Announcement one = self("one"), two = self("second");
    auto first = Announcing::start(one, kBeacon);
    auto second = Announcing::start(two, kBeacon);
    ASSERT_TRUE(first && second);
    const int64_t beganNs = monotonicNowNs();
    const auto both = [&](const std::vector<FoundNode>& nodes) { return has(nodes, one) && has(nodes, two); };
    const Discovered d = discoverNodes(kBeacon, Deadline::inMs(10'000), both);
    if (!d.beaconTrouble.empty() && d.nodes.empty()) GTEST_SKIP() << "no multicast here: " << d.beaconTrouble;
    EXPECT_TRUE(both(d.nodes));
    EXPECT_LT(monotonicNowNs() - beganNs, 5 * kNsPerS);
    // The goodbye ends it long before the silence limit.
    int64_t endedNs = 0;
    const auto gone = [&](const std::vector<FoundNode>& nodes) {
        if (endedNs == 0 && both(nodes)) {
            first->reset();
            endedNs = monotonicNowNs();
        }
        return endedNs != 0 && !has(nodes, one);
    };
    const Discovered later = discoverNodes(kBeacon, Deadline::inMs(10'000), gone);
    EXPECT_FALSE(has(later.nodes, one));
    EXPECT_TRUE(has(later.nodes, two));
    EXPECT_LT(monotonicNowNs() - endedNs, NodeTable::kSilentNs - kNsPerS);
}

TEST(Discovery, findsNothingWhenDisabled) {
    const Announcement one = self("off");
    const auto first = Announcing::start(one, {false, false, {}});
    ASSERT_TRUE(first);
    EXPECT_FALSE(has(discoverNodes(kBeacon, Deadline::inMs(300)).nodes, one));
    EXPECT_TRUE(discoverNodes({false, false, {}}, Deadline::inMs(50)).nodes.empty());
}

TEST(Discovery, reportsAMissingInterface) {
    const Discovered d = discoverNodes({true, false, "none7"}, Deadline::inMs(50));
    EXPECT_NE(d.beaconTrouble.find("\"none7\""), std::string::npos) << d.beaconTrouble;
}

} // namespace
} // namespace mural
