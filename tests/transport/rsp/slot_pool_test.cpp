// Payload slots are unique, lowest first, so a reader that returns them at once uses few.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>
#include <set>

#include "transport/rsp/protocol/slot_pool.hpp"

namespace mural::rsp {
namespace {

constexpr uint32_t kSlots = 256;
constexpr size_t kBytes = 100;

TEST(SlotPool, providesTheRequestedNumber) {
    SlotPool slots(kBytes, kSlots);
    std::set<uint32_t> taken;
    for (uint32_t i = 0; i < kSlots; ++i) {
        const uint32_t slot = slots.take();
        EXPECT_LT(slot, kSlots);
        EXPECT_TRUE(taken.insert(slot).second) << slot << " came twice";
        EXPECT_EQ(slots.at(slot), slots.at(0) + slot * kBytes);
    }
}

TEST(SlotPool, usesFewSlotsWhenTheyAreReturnedAtOnce) {
    SlotPool slots(kBytes, kSlots);
    uint32_t highest = 0;
    std::deque<uint32_t> held;
    for (int i = 0; i < 10'000; ++i) {
        held.push_back(slots.take());
        highest = std::max(highest, held.back());
        if (held.size() == 40) {
            for (; held.size() > 8; held.pop_front()) slots.giveBack(held.front());
        }
    }
    EXPECT_EQ(highest, 39u);
}

TEST(SlotPool, returnsTheLowestFreeSlotInAnyOrder) {
    constexpr unsigned kSeed = 7;
    std::mt19937 random(kSeed);
    SlotPool slots(kBytes, kSlots);
    std::set<uint32_t> free, held;
    for (uint32_t i = 0; i < kSlots; ++i) free.insert(i);
    for (int i = 0; i < 20'000; ++i) {
        if (held.empty() || (!free.empty() && random() % 2 == 0)) {
            const uint32_t slot = slots.take();
            ASSERT_EQ(slot, *free.begin()) << "seed " << kSeed << ", step " << i;
            held.insert(free.extract(free.begin()).value());
        } else {
            const auto it = std::next(held.begin(), static_cast<std::ptrdiff_t>(random() % held.size()));
            slots.giveBack(*it);
            free.insert(held.extract(it).value());
        }
    }
}

} // namespace
} // namespace mural::rsp
