// Reads a machine's network settings from a fake /proc and /sys.
#include "tools/mural/network/machine_facts.hpp"

#include <filesystem>
#include <fstream>
#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace mural::cli {
namespace {

class MadeUpMachine : public testing::Test {
protected:
    MadeUpMachine() : root_(testing::TempDir() + "/mural_machine_" + std::to_string(::getpid())) {
        card_.name = "eth7";
    }
    ~MadeUpMachine() override { std::filesystem::remove_all(root_); }
    void file(const std::string& path, const std::string& text) const {
        std::filesystem::create_directories(std::filesystem::path(root_ + path).parent_path());
        std::ofstream(root_ + path) << text << "\n";
    }
    std::string root_;
    rsp::NetworkInterface card_;
};

TEST_F(MadeUpMachine, reportsLimitsBridgesAndFilters) {
    file("/proc/sys/net/core/rmem_max", "212992");
    file("/proc/sys/net/ipv4/conf/all/rp_filter", "0");
    file("/proc/sys/net/ipv4/conf/eth7/rp_filter", "1");
    for (const auto& [bridge, snoops, queries] : {std::tuple("br1", "1", "0"), std::tuple("br0", "1", "0"),
                                                  std::tuple("br2", "1", "1"), std::tuple("br3", "0", "0")}) {
        file(std::string("/sys/class/net/") + bridge + "/bridge/multicast_snooping", snoops);
        file(std::string("/sys/class/net/") + bridge + "/bridge/multicast_querier", queries);
    }
    file("/sys/class/net/eth7/mtu", "1500");
    const MachineFacts f = readMachineFacts(card_, 1000, root_);
    EXPECT_EQ(f.receiveLimitBytes, 212992u);
    EXPECT_FALSE(f.sendLimitBytes.has_value());
    EXPECT_TRUE(f.strictReturnPath);
    EXPECT_EQ(f.silentBridges, (std::vector<std::string>{"br0", "br1"}));
    const MachineFacts again = machineFactsFrom(toJson(f));
    EXPECT_EQ(toJson(again), toJson(f));
}

// The loosest setting of the kernel (2) is a larger number than the strict one.
TEST_F(MadeUpMachine, reportsTheLooseFilterAsNotStrict) {
    file("/proc/sys/net/ipv4/conf/all/rp_filter", "1");
    file("/proc/sys/net/ipv4/conf/eth7/rp_filter", "2");
    EXPECT_FALSE(readMachineFacts(card_, 1000, root_).strictReturnPath);
}

TEST_F(MadeUpMachine, addsTheDropsOfAllQueues) {
    file("/proc/net/softnet_stat", "0001d3a1 00000010 00000002\n0000ffff 0000000a 00000000");
    EXPECT_EQ(droppedByQueues(root_), 26u);
    EXPECT_EQ(droppedByQueues(root_ + "/gone"), 0u);
}

TEST_F(MadeUpMachine, toleratesAnswersOfAnotherFormat) {
    const MachineFacts f = machineFactsFrom({{"interface", 7},
                                             {"mtu", "long"},
                                             {"multicast", "yes"},
                                             {"silentBridges", {1, "br0"}},
                                             {"receiveLimitBytes", {}}});
    EXPECT_EQ(f.mtuBytes, 0u);
    EXPECT_EQ(f.silentBridges, std::vector<std::string>{"br0"});
}

} // namespace
} // namespace mural::cli
