// The lease of the input, keys, places of the pointer, and the program's display.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/clock.hpp"
#include "nodes/input/keyboard_map.hpp"
#include "nodes/input/pointer_place.hpp"
#include "nodes/input/program_display.hpp"
#include "tools/mural/page/input/input_lease.hpp"

namespace mural::page {
namespace {

using namespace input;

constexpr int64_t kS = kNsPerS;

TEST(InputLease, viewersNeverPass) {
    for (const InputMode mode : {InputMode::Click, InputMode::Ask, InputMode::Owner, InputMode::All}) {
        InputLease lease(mode);
        EXPECT_FALSE(lease.passes(1, Role::View, true, false, kS));
        EXPECT_FALSE(lease.take(1, Role::View, kS));
        EXPECT_EQ(lease.holder(), 0);
    }
}

TEST(InputLease, givesAnIdleLeaseToAClick) {
    InputLease lease(InputMode::Click);
    EXPECT_FALSE(lease.passes(1, Role::Input, false, false, kS)); // a move takes nothing
    EXPECT_TRUE(lease.passes(1, Role::Input, true, false, kS));
    EXPECT_FALSE(lease.passes(2, Role::Input, true, false, kS + kS / 2)); // not idle yet
    EXPECT_FALSE(lease.passes(2, Role::Input, true, true, 3 * kS));       // the holder drags
    EXPECT_TRUE(lease.passes(2, Role::Input, true, false, 3 * kS));
    EXPECT_FALSE(lease.passes(1, Role::Input, false, false, 3 * kS));
    EXPECT_EQ(lease.holder(), 2);
}

TEST(InputLease, operatorsTakeItFromOthers) {
    InputLease lease(InputMode::Ask);
    EXPECT_FALSE(lease.passes(1, Role::Input, true, false, kS));
    EXPECT_TRUE(lease.take(1, Role::Input, kS));
    EXPECT_FALSE(lease.take(2, Role::Input, kS));
    EXPECT_TRUE(lease.take(3, Role::Operate, kS));
    EXPECT_EQ(lease.holder(), 3);
    EXPECT_FALSE(lease.release(1));
    EXPECT_TRUE(lease.release(3));
}

TEST(InputLease, ownerModeExcludesOthers) {
    InputLease lease(InputMode::Owner);
    EXPECT_FALSE(lease.take(1, Role::Input, kS));
    EXPECT_FALSE(lease.passes(1, Role::Input, true, false, kS));
    EXPECT_TRUE(lease.passes(2, Role::Operate, true, false, kS));
}

TEST(InputLease, allModeNeedsNoLease) {
    InputLease lease(InputMode::All);
    EXPECT_TRUE(lease.passes(1, Role::Input, false, true, kS));
    EXPECT_TRUE(lease.passes(2, Role::Input, true, true, kS));
}

TEST(PointerPlace, coversEveryPixelOnce) {
    constexpr int kPixels = 640;
    for (int pixel = 0; pixel < kPixels; ++pixel) EXPECT_EQ(pixelAt((pixel + 0.5) / kPixels, kPixels), pixel);
    EXPECT_EQ(pixelAt(0, kPixels), 0);
    EXPECT_EQ(pixelAt(1, kPixels), kPixels - 1);
    EXPECT_EQ(pixelAt(1, 0), 0);
}

TEST(WheelSteps, gathersParts) {
    double rest = 0;
    EXPECT_TRUE(wheelSteps(rest, 60).empty());
    EXPECT_EQ(wheelSteps(rest, 60), std::vector<int>{1});
    EXPECT_EQ(wheelSteps(rest, -360), (std::vector<int>{-1, -1, -1}));
    EXPECT_TRUE(wheelSteps(rest, 100).empty());
    EXPECT_TRUE(wheelSteps(rest, -100).empty()); // the direction changed
    EXPECT_LE(wheelSteps(rest, 12000).size(), 20U);
}

TEST(Keysyms, mapsBrowserKeys) {
    EXPECT_EQ(keysymOfKey("a", "KeyA"), Keysym{'a'});
    EXPECT_EQ(keysymOfKey("A", "KeyA"), Keysym{'A'});
    EXPECT_EQ(keysymOfKey("\xc3\xa4", "Quote"), 0xe4U);          // ä
    EXPECT_EQ(keysymOfKey("\xe2\x82\xac", "KeyE"), 0x010020acU); // €
    EXPECT_EQ(keysymOfKey("Enter", "NumpadEnter"), 0xff0dU);
    EXPECT_EQ(keysymOfKey("Shift", "ShiftRight"), 0xffe2U);
    EXPECT_EQ(keysymOfKey("AltGraph", "AltRight"), 0xfe03U);
    EXPECT_EQ(keysymOfKey("F12", "F12"), 0xffc9U);
    for (const char* none : {"Dead", "Process", "F0", "F25", "Unidentified", "\xff"})
        EXPECT_EQ(keysymOfKey(none, ""), kNoKeysym) << none;
}

TEST(CodePoints, skipInvalidBytes) {
    EXPECT_EQ(codePointsOf("a\xc3\xa4\xf0\x9f\x98\x80"), (std::vector<char32_t>{'a', 0xe4, 0x1f600}));
    EXPECT_EQ(codePointsOf("\xff"
                           "a\xc3"),
              (std::vector<char32_t>{'a'}));
    EXPECT_TRUE(codePointsOf("\xf0\x9f").empty());
}

class KeyboardMapTest : public ::testing::Test {
protected:
    // Keycodes 8 to 11: nothing; a; "," with ";"; "q" with Q and, at the third level, "@".
    KeyboardMap map_{8, 6, {0, 0, 0, 0, 0, 0, 'a', 0, 0, 0, 0, 0, ',', ';', 0, 0, 0, 0, 'q', 'Q', 0, 0, '@', 0}};
};

TEST_F(KeyboardMapTest, findsKeycodeAndLevel) {
    EXPECT_EQ(map_.find('a')->keycode, 9);
    EXPECT_EQ(map_.find(';')->keycode, 10);
    EXPECT_EQ(map_.find(';')->level, KeyLevel::Shift);
    EXPECT_EQ(map_.find('A')->level, KeyLevel::Shift);
    EXPECT_EQ(map_.find('@')->level, KeyLevel::Level3);
    EXPECT_FALSE(map_.find('z').has_value());
    EXPECT_FALSE(KeyboardMap().find('a').has_value());
}

TEST_F(KeyboardMapTest, bindsFreeKeycodes) {
    EXPECT_EQ(map_.freeKeycodes(), std::vector<uint8_t>{8});
    map_.bind(8, 0x010020ac);
    EXPECT_EQ(map_.find(0x010020ac)->keycode, 8);
    EXPECT_EQ(map_.find(0x010020ac)->level, KeyLevel::Plain);
    EXPECT_TRUE(map_.freeKeycodes().empty());
}

TEST(ProgramDisplay, readsVariables) {
    using namespace std::string_view_literals;
    const std::string_view environment = "A=1\0DISPLAY=:7\0XAUTHORITY=/proc/1/fd/3\0"sv;
    EXPECT_EQ(variableIn(environment, "DISPLAY"), ":7");
    EXPECT_EQ(variableIn(environment, "XAUTHORITY"), "/proc/1/fd/3");
    EXPECT_EQ(variableIn(environment, "DISPLA"), "");
    EXPECT_EQ(variableIn("", "DISPLAY"), "");
}

TEST(ProgramDisplay, readsCookiesOfAnyBytes) {
    using namespace std::string_literals;
    const std::string entry = "\xff\xff"s + "\0\0"s + "\0\x01"s + "7"s + "\0\x12"s + "MIT-MAGIC-COOKIE-1"s + "\0\x10"s;
    EXPECT_EQ(cookieIn(entry + "0123456789abcdef"), "0123456789abcdef");
    EXPECT_EQ(cookieIn(entry + "0123"), ""); // cut
    EXPECT_EQ(cookieIn(""), "");
    EXPECT_EQ(cookieIn("\xff"), "");
}

} // namespace
} // namespace mural::page
