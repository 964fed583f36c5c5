// The choice between delta coding and plain records, with simulated times, sizes and links.
#include <gtest/gtest.h>

#include "streamcodec/delta/mode_selector.hpp"

namespace mural::delta {
namespace {

constexpr uint64_t kRawBytes = 100'000;
constexpr double kLinkNsPerByte = 32;

struct Made {
    uint64_t wireBytes;
    int64_t ns;
};

// The number of plain frames among the last `last` of `frames`.
int plainOf(ModeSelector& choice, Made coded, Made plain, int frames, int last, double linkNsPerByte = kLinkNsPerByte,
            uint64_t pageBytes = 0) {
    int count = 0;
    for (int i = 0; i < frames; ++i) {
        count += choice.plain() && i >= frames - last;
        const Made& made = choice.plain() ? plain : coded;
        choice.measured(kRawBytes, pageBytes, made.wireBytes, made.ns, linkNsPerByte);
    }
    return count;
}

TEST(ModeSelector, usesTheDictionaryFirst) { EXPECT_FALSE(ModeSelector().plain()); }

TEST(ModeSelector, becomesPlainWhereTheDictionaryCostsMoreThanItSaves) {
    ModeSelector choice;
    EXPECT_GE(plainOf(choice, {3000, 450'000}, {5000, 110'000}, 400, 300), 280);
}

TEST(ModeSelector, usesTheDictionaryOnASlowLink) {
    ModeSelector choice;
    EXPECT_LE(plainOf(choice, {3000, 450'000}, {5000, 110'000}, 400, 300, 640), 20);
}

TEST(ModeSelector, usesTheDictionaryWhereItIsCheap) {
    ModeSelector choice;
    EXPECT_EQ(plainOf(choice, {10, 4'000}, {100, 1'000}, 400, 400), 0) << "not even tried: nothing is to be won";
    ModeSelector other;
    EXPECT_LE(plainOf(other, {10, 40'000}, {2400, 50'000}, 400, 300), 20);
}

// 400 more bytes would take longer than the dictionary, but small frames become plain only at half of the time.
TEST(ModeSelector, keepsSmallFramesSmallUnlessThatIsTooExpensive) {
    ModeSelector near, far;
    EXPECT_LE(plainOf(near, {50, 9'000}, {450, 6'000}, 400, 300), 20);
    EXPECT_GE(plainOf(far, {50, 9'000}, {450, 3'500}, 400, 300), 280);
    ModeSelector back; // and returns when it is no longer
    plainOf(back, {50, 9'000}, {450, 3'500}, 400, 1);
    ASSERT_TRUE(back.plain());
    EXPECT_LE(plainOf(back, {50, 5'500}, {450, 3'500}, 3000, 100), 5);
}

TEST(ModeSelector, usesTheDictionaryForPages) {
    ModeSelector choice;
    EXPECT_EQ(plainOf(choice, {3000, 450'000}, {5000, 110'000}, 400, 400, kLinkNsPerByte, kRawBytes * 3 / 4), 0);
}

TEST(ModeSelector, retriesSoonAfterACompleteChange) {
    ModeSelector choice;
    plainOf(choice, {3000, 450'000}, {5000, 110'000}, 1000, 1);
    ASSERT_TRUE(choice.plain());
    EXPECT_LE(plainOf(choice, {10, 30'000}, {30'000, 300'000}, 60, 20), 0);
}

TEST(ModeSelector, timesFewFramesButAllDecisiveOnes) {
    ModeSelector choice;
    int timed = 0, plain = 0;
    for (int i = 0; i < 1000; ++i) {
        const bool wants = choice.wantsTime();
        timed += wants;
        plain += choice.plain();
        if (wants)
            choice.measured(kRawBytes, 0, choice.plain() ? 5000 : 3000, choice.plain() ? 110'000 : 450'000,
                            kLinkNsPerByte);
        else
            choice.unmeasured();
    }
    EXPECT_LE(timed, 250);
    EXPECT_GE(plain, 900) << "it decides as if all were timed";
}

// The dictionary takes five times as long: trials cost 2 % of the total.
TEST(ModeSelector, triesRarelyWhenTrialsAreExpensive) {
    ModeSelector choice;
    plainOf(choice, {3000, 2'400'000}, {5000, 480'000}, 100, 1);
    EXPECT_GE(plainOf(choice, {3000, 2'400'000}, {5000, 480'000}, 2000, 2000), 1992);
}

// Reading the clock takes as long as encoding such a frame.
TEST(ModeSelector, timesCheapFramesRarely) {
    ModeSelector choice;
    int timed = 0;
    for (int i = 0; i < 4000; ++i) {
        if (choice.wantsTime())
            ++timed, choice.measured(52, 0, 2, 500, kLinkNsPerByte);
        else
            choice.unmeasured();
    }
    EXPECT_LE(timed, 4000 / 16);
    EXPECT_GT(timed, 4000 / 64) << "they may become dear";
}

TEST(ModeSelector, ignoresOneOutlier) {
    ModeSelector choice;
    plainOf(choice, {3000, 450'000}, {5000, 110'000}, 300, 1);
    choice.measured(kRawBytes, 0, 50'000, 5'000'000, kLinkNsPerByte);
    EXPECT_GE(plainOf(choice, {3000, 450'000}, {5000, 110'000}, 100, 60), 50);
}

// The first frame is all new. If the second takes several times as long per byte, the next three use no dictionary.
TEST(ModeSelector, becomesPlainAtOnceAfterAnExpensiveSecondFrame) {
    const auto second = [](uint64_t rawBytes, uint64_t pageBytes, int64_t ns) {
        ModeSelector choice;
        choice.measured(400'000, 200'000, 40'000, 800'000, kLinkNsPerByte);
        choice.measured(rawBytes, pageBytes, 1600, ns, kLinkNsPerByte);
        return choice.plain();
    };
    EXPECT_TRUE(second(18'000, 0, 170'000));
    EXPECT_FALSE(second(18'000, 0, 60'000)) << "hardly dearer than new bytes";
    EXPECT_FALSE(second(1000, 0, 15'000)) << "nothing to be won";
    EXPECT_FALSE(second(18'000, 10'000, 170'000)) << "pages";
    ModeSelector choice; // a wrong decision is detected soon
    choice.measured(400'000, 200'000, 40'000, 800'000, kLinkNsPerByte);
    choice.measured(18'000, 0, 1600, 170'000, kLinkNsPerByte);
    EXPECT_EQ(plainOf(choice, {10, 20'000}, {9000, 90'000}, 200, 40), 0);
}

// In `batches` batches, most records became plain after many new ones.
void addMostlyPlain(ModeSelector& choice, int batches) {
    for (int i = 0; i < batches; ++i) choice.mostlyPlain();
}

TEST(ModeSelector, becomesPlainWhereAllIsNewAfterTheFirstFrame) {
    ModeSelector choice;
    choice.mostlyPlain();
    EXPECT_FALSE(choice.plain()) << "all of the first is new";
    choice.mostlyPlain();
    EXPECT_TRUE(choice.plain());
    ModeSelector other;
    plainOf(other, {3000, 40'000}, {5000, 50'000}, 1, 1);
    other.mostlyPlain();
    EXPECT_TRUE(other.plain());
}

TEST(ModeSelector, triesSoonWhereNewRecordsRepeat) {
    ModeSelector choice;
    addMostlyPlain(choice, 2);
    EXPECT_LE(plainOf(choice, {10, 40'000}, {300, 100'000}, 60, 20), 0);
    ModeSelector other; // otherwise not soon
    addMostlyPlain(other, 2);
    EXPECT_EQ(plainOf(other, {3000, 450'000}, {8000, 110'000}, 120, 120), 120);
}

TEST(ModeSelector, endsATrialWithOmittedRecords) {
    ModeSelector choice;
    plainOf(choice, {3000, 450'000}, {5000, 110'000}, 400, 1);
    int tries = 0;
    for (int i = 0; i < 4000; ++i) {
        if (choice.plain())
            choice.measured(kRawBytes, 0, 5000, 110'000, kLinkNsPerByte);
        else
            ++tries, choice.mostlyPlain();
    }
    EXPECT_GE(tries, 1);
    EXPECT_LE(tries, 16);
}

} // namespace
} // namespace mural::delta
