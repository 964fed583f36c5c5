// The effect of losses on the rate: none for a lossy link or chance, enough for congestion.
#include "transport/rsp/protocol/rate_control.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace mural::rsp {
namespace {

constexpr double kMax = 25e6;
constexpr double kDatagramBytes = 1538;
constexpr int64_t kRoundNs = 50'000'000;

// The loss rate of the unluckiest member per round of at least 256 datagrams.
struct Rounds {
    std::mt19937 random{7};
    int64_t nowNs = 0;

    void run(RateControl& rate, int count, int members, auto lossAt) {
        for (int i = 0; i < count; ++i) {
            const double perS = rate.bytesPerS() / kDatagramBytes;
            const auto datagrams = static_cast<int>(std::max(256.0, perS * 1e-9 * kRoundNs));
            std::binomial_distribution<int> lost(datagrams, lossAt(rate.bytesPerS()));
            int worst = 0;
            for (int m = 0; m < members; ++m) worst = std::max(worst, lost(random));
            nowNs += static_cast<int64_t>(datagrams / perS * 1e9);
            rate.roundEnded(static_cast<double>(worst) / datagrams, datagrams, nowNs);
        }
    }
};

TEST(RateControl, keepsTheRateOnALossyLink) {
    for (const double share : {0.001, 0.01, 0.05, 0.15}) {
        RateControl rate({kMax});
        Rounds rounds;
        double sum = 0;
        for (int i = 0; i < 400; ++i) {
            rounds.run(rate, 1, 8, [&](double) { return share; });
            sum += rate.bytesPerS();
        }
        EXPECT_GT(sum / 400, 0.93 * kMax) << share;
    }
}

TEST(RateControl, reducesTheRateUnderCongestion) {
    RateControl rate({kMax});
    Rounds rounds;
    const double room = 0.4 * kMax;
    rounds.run(rate, 400, 4, [&](double bytesPerS) { return std::clamp(1 - room / bytesPerS, 0.0, 1.0); });
    double sum = 0;
    for (int i = 0; i < 200; ++i) {
        rounds.run(rate, 1, 4, [&](double bytesPerS) { return std::clamp(1 - room / bytesPerS, 0.0, 1.0); });
        sum += rate.bytesPerS();
    }
    EXPECT_LT(sum / 200, 1.25 * room);
    EXPECT_GT(sum / 200, 0.75 * room);
}

TEST(RateControl, increasesTheRateAgain) {
    RateControl rate({kMax});
    Rounds rounds;
    rounds.run(rate, 100, 4, [](double bytesPerS) { return std::clamp(1 - 0.1 * kMax / bytesPerS, 0.0, 1.0); });
    ASSERT_LT(rate.bytesPerS(), 0.5 * kMax);
    const int64_t beganNs = rounds.nowNs;
    while (rate.bytesPerS() < 0.99 * kMax && rounds.nowNs - beganNs < 20'000'000'000)
        rounds.run(rate, 1, 4, [](double) { return 0.0; });
    EXPECT_GT(rate.bytesPerS(), 0.98 * kMax) << "within 20 s";
}

TEST(RateControl, compensatesForASleepWithItsBucket) {
    RateControl rate({kMax});
    while (rate.take(kDatagramBytes, 0)) {}
    double sent = 0;
    while (rate.take(kDatagramBytes, 4'000'000)) sent += kDatagramBytes;
    EXPECT_NEAR(sent, kMax * 0.004, 2 * kDatagramBytes);
    // But only for short sleeps: queues on the path are finite.
    sent = 0;
    while (rate.take(kDatagramBytes, 1'000'000'000)) sent += kDatagramBytes;
    EXPECT_LT(sent, kMax * 0.006);
}

TEST(RateControl, reportsWhetherABatchMayBeSent) {
    RateControl rate({kMax});
    while (rate.take(kDatagramBytes, 0)) {}
    EXPECT_FALSE(rate.has(10 * kDatagramBytes, 500'000));
    EXPECT_TRUE(rate.has(10 * kDatagramBytes, 700'000));
    EXPECT_TRUE(rate.take(10 * kDatagramBytes, 700'000)) << "to ask takes nothing";
    EXPECT_FALSE(rate.has(kMax, 4'000'000));
    EXPECT_TRUE(rate.has(kMax, 1'000'000'000)) << "more never goes at once";
    EXPECT_TRUE(RateControl({}).has(1e12, 0)) << "no limit";
}

} // namespace
} // namespace mural::rsp
