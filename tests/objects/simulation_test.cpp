// Random schedules. MURAL_OBJECT_STEPS sets the number of steps of each mode (default 60 000; under sanitizers 6 000);
// MURAL_OBJECT_SEED the first seed. A failure prints its seed.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/objects/object_simulation.hpp"
#include "tests/sanitized.hpp"

namespace mural::objects::test {
namespace {

uint64_t environmentOr(const char* name, uint64_t otherwise) {
    const char* const text = std::getenv(name);
    return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

void runSchedules(bool usesKeeper) {
    constexpr int kStepsPerSeed = 2000;
    const uint64_t steps = environmentOr("MURAL_OBJECT_STEPS", testing::kSanitized ? 6'000 : 60'000);
    const uint64_t first = environmentOr("MURAL_OBJECT_SEED", 1);
    uint64_t delivered = 0, commits = 0, states = 0;
    for (uint64_t seed = first; seed < first + steps / kStepsPerSeed; ++seed) {
        ObjectSimulation simulation({.seed = seed, .steps = kStepsPerSeed, .usesKeeper = usesKeeper});
        ASSERT_EQ(simulation.run(), "");
        delivered += simulation.delivered();
        commits += simulation.commits();
        states += simulation.states();
    }
    std::printf("seeds from %llu on: %llu commits, %llu messages, %llu states compared\n",
                static_cast<unsigned long long>(first), static_cast<unsigned long long>(commits),
                static_cast<unsigned long long>(delivered), static_cast<unsigned long long>(states));
}

// Runs seeds until the fault has been planted ten times, or under sanitizers twice. Returns the share of runs that
// deviate from the model. A fault has no effect if its reader is lost, or its object ends or is sent whole, soon after
// it.
double shareThatFinds(Fault fault) {
    constexpr int kWanted = testing::kSanitized ? 2 : 10;
    int planted = 0, found = 0;
    for (uint64_t seed = 1; planted < kWanted && seed < 200; ++seed) {
        ObjectSimulation simulation({.seed = seed, .steps = 1500, .fault = fault});
        found += !simulation.run().empty();
        planted += simulation.hasFault();
    }
    return double(found) / kWanted;
}

TEST(ObjectSimulation, showsReadersTheModelWithAKeeper) { runSchedules(true); }
TEST(ObjectSimulation, showsReadersTheModelWithoutAKeeper) { runSchedules(false); }

TEST(ObjectSimulation, findsALostDelta) { EXPECT_GE(shareThatFinds(Fault::DeltaLost), 0.8); }
TEST(ObjectSimulation, findsSwappedCommits) { EXPECT_GE(shareThatFinds(Fault::OrderSwapped), 0.8); }
TEST(ObjectSimulation, findsAWrongVersion) { EXPECT_GE(shareThatFinds(Fault::WrongVersion), 0.8); }
TEST(ObjectSimulation, findsAKeptToken) { EXPECT_GE(shareThatFinds(Fault::TokenKept), 0.5); }

} // namespace
} // namespace mural::objects::test
