// Changed words round-trip whatever they are, and smooth motion is cheap.
#include <bit>
#include <cmath>
#include <limits>

#include "streamcodec/delta/entropy/word_predictor.hpp"
#include "tests/delta/both_sides.hpp"

namespace mural::delta::testing {
namespace {

using Words = std::vector<uint32_t>;

// Encodes and decodes frames of one entry; returns the size of each.
class OneItem {
public:
    explicit OneItem(uint32_t modelWords = 4096) : writing_(modelWords), reading_(modelWords) {}

    size_t send(const Words& words) {
        const auto bytes = std::as_bytes(std::span(last_));
        if (last_.size() != words.size()) {
            last_ = words;
            return 0;
        }
        writing_.begin(written_, bytes);
        for (uint32_t i = 0; i < words.size(); ++i) {
            if (words[i] != last_[i]) {
                EXPECT_EQ(writing_.code(writer_, i, last_[i], words[i]), words[i]);
            }
        }
        writing_.end();
        const auto written = writer_.finish();
        const Bytes coded(written.begin(), written.end());
        writer_.clear();
        RangeReader reader(coded);
        reading_.begin(read_, bytes);
        for (uint32_t i = 0; i < words.size(); ++i) {
            if (words[i] != last_[i]) {
                EXPECT_EQ(reading_.code(reader, i, last_[i], 0), words[i]);
            }
        }
        reading_.end();
        EXPECT_FALSE(reader.bad());
        last_ = words;
        return coded.size();
    }

private:
    WordPredictor writing_, reading_;
    RangeWriter writer_;
    DictionaryEntry written_, read_;
    Words last_;
};

uint32_t wordOf(double value) { return std::bit_cast<uint32_t>(static_cast<float>(value)); }

TEST(WordPredictor, roundTripsAnyWords) {
    std::mt19937 random(1);
    const Words odd{0,          1,          0x80000000, 0xffffffff, 0x7f800000, 0xff800000, 0x7fc00001,
                    0xffc12345, 0x00000001, 0x807fffff, 0x7f7fffff, 0xff7fffff, 0x3f800000, 0xbf800000};
    for (const uint32_t modelWords : {1024u, 4096u}) {
        OneItem item(modelWords);
        for (int frame = 0; frame < 400; ++frame) {
            Words words(100);
            for (auto& w : words)
                w = random() % 3 == 0   ? static_cast<uint32_t>(random())
                    : random() % 2 == 0 ? odd[random() % odd.size()]
                                        : wordOf(frame * 0.1);
            (void)item.send(words);
        }
    }
}

// A matrix that rotates in unequal steps changes 8 words: 32 bytes without prediction.
TEST(WordPredictor, encodesRotationInAFewBytes) {
    OneItem item;
    std::mt19937 random(2);
    double angle = 0, sum = 0;
    for (int frame = 0; frame < 300; ++frame) {
        angle += 0.01 + 0.002 * static_cast<double>(random() % 1000) / 1000;
        Words words(16, wordOf(1));
        for (size_t row = 0; row < 4; ++row) {
            words[row] = wordOf((1 + 0.3 * static_cast<double>(row)) * std::cos(angle));
            words[row + 8] = wordOf((1 - 0.2 * static_cast<double>(row)) * std::sin(angle));
        }
        const size_t bytes = item.send(words);
        if (frame >= 100) sum += static_cast<double>(bytes);
    }
    EXPECT_LE(sum / 200, 10);
}

TEST(WordPredictor, encodesCountersAndRepeatedValuesAtNearlyNoCost) {
    OneItem item;
    std::mt19937 random(3);
    double sum = 0;
    for (uint32_t frame = 0; frame < 300; ++frame) {
        Words words{7, frame, 5 * frame, 0, 0, 0};
        words[3] = static_cast<uint32_t>(random()) & 0x7fffffff; // unpredictable
        words[4] = words[3];
        words[5] = words[3] | 0x80000000;
        const size_t bytes = item.send(words);
        if (frame >= 100) sum += static_cast<double>(bytes);
    }
    EXPECT_LE(sum / 200, 6.5); // four of them random
}

} // namespace
} // namespace mural::delta::testing
