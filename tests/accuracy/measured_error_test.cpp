// Errors of known pictures, bounds at their limits, and the reports of both.
#include <gtest/gtest.h>

#include <cmath>

#include "tools/mural/accuracy/plot/accuracy_plot.hpp"
#include "tools/mural/accuracy/accuracy_text.hpp"

namespace mural::cli {
namespace {

OwnedPicture grey(int width, int height, int value) {
    OwnedPicture p(width, height);
    for (size_t i = 0; i < p.view().sizeBytes(); ++i) p.data()[i] = static_cast<std::byte>(value);
    return p;
}

TEST(MeasuredError, measuresKnownPictures) {
    const OwnedPicture black = grey(5, 4, 0), one = grey(5, 4, 1), white = grey(5, 4, 255);
    const MeasuredError none = errorOf(black.view(), black.view());
    EXPECT_EQ(none.pixels, 20);
    EXPECT_EQ(none.differing, 0);
    EXPECT_FALSE(none.psnr());
    EXPECT_NEAR(errorOf(black.view(), white.view()).psnr().value(), 0, 1e-12);
    EXPECT_NEAR(errorOf(black.view(), one.view()).psnr().value(), 48.1308, 1e-4); // 20 log 255
    OwnedPicture spot = grey(5, 4, 0);
    spot.row(2)[4 * 3 + 1] = std::byte{9};
    const MeasuredError error = errorOf(black.view(), spot.view());
    EXPECT_EQ(error.differing, 1);
    EXPECT_EQ(error.largest, 9);
    EXPECT_DOUBLE_EQ(error.rootMeanSquare(), 9 / std::sqrt(60.0));
    spot.row(2)[4 * 3 + 3] = std::byte{9};
    EXPECT_EQ(errorOf(black.view(), spot.view()).squares, 81) << "the fourth byte is no colour";
}

TEST(MeasuredError, countsAllPixelsWhenSizesDiffer) {
    const MeasuredError error = errorOf(grey(5, 4, 7).view(), grey(4, 5, 7).view());
    EXPECT_EQ(error.pixels, 20);
    EXPECT_EQ(error.differing, 20);
    EXPECT_EQ(error.largest, 255);
}

TEST(MeasuredError, addsUp) {
    MeasuredError sum = errorOf(grey(5, 4, 0).view(), grey(5, 4, 0).view());
    sum.add(errorOf(grey(5, 4, 0).view(), grey(5, 4, 2).view()));
    EXPECT_EQ(sum.pixels, 40);
    EXPECT_EQ(sum.differingShare(), 0.5);
    EXPECT_DOUBLE_EQ(sum.rootMeanSquare(), std::sqrt(2.0));
}

TEST(Bound, holdsUpToItsLimit) {
    MeasuredError error = errorOf(grey(10, 10, 0).view(), grey(10, 10, 0).view());
    EXPECT_TRUE(Bound::exact().holds(error));
    EXPECT_FALSE(Bound::exact().holds({})) << "nothing was compared";
    error.differing = 1;
    error.addValue(4);
    EXPECT_FALSE(Bound::exact().holds(error));
    EXPECT_TRUE((Bound{0.01, 4.0, {}}).holds(error));
    EXPECT_FALSE((Bound{0.0099, {}, {}}).holds(error));
    EXPECT_FALSE((Bound{{}, 3.9, {}}).holds(error));
    const double psnr = error.psnr().value();
    EXPECT_TRUE((Bound{{}, {}, psnr}).holds(error));
    EXPECT_FALSE((Bound{{}, {}, psnr + 0.1}).holds(error));
    EXPECT_EQ(Bound::exact().text(), "equal");
    EXPECT_EQ((Bound{0.0025, {}, 50.0}).text(), "≤ 0.25 % differ, ≥ 50 dB");
    EXPECT_EQ(Bound{}.text(), "none");
}

TEST(AccuracyReport, namesBrokenBoundsAndFailures) {
    AccuracyReport report{"scenes & <more>", "", {}};
    EXPECT_FALSE(report.holds()) << "nothing was measured";
    AccuracyRow row{"group", "good", "native", errorOf(grey(5, 4, 0).view(), grey(5, 4, 0).view()), Bound::exact(), {}};
    report.rows.push_back(row);
    EXPECT_TRUE(report.holds());
    row.what = "bad";
    row.error = errorOf(grey(5, 4, 0).view(), grey(5, 4, 1).view());
    report.rows.push_back(row);
    row.what = "lost";
    row.failure = "why it was";
    report.rows.push_back(row);
    EXPECT_FALSE(report.holds());
    const std::string table = tableOf(report);
    EXPECT_NE(table.find("BROKEN"), std::string::npos) << table;
    EXPECT_NE(table.find("lost: FAILED: why it was"), std::string::npos) << table;
    EXPECT_NE(table.find("\n2 measured, 1 broken, 1 failed\n"), std::string::npos) << table;
    EXPECT_NE(plotOf(report).find("scenes &amp; &lt;more&gt;"), std::string::npos);
    EXPECT_NE(jsonOf(report).find("\"failure\": \"why it was\""), std::string::npos);
}

TEST(AccuracyReport, returnsAStatusForTheMeasuredRows) {
    const AccuracyRow good{"group",        "good", "native", errorOf(grey(5, 4, 0).view(), grey(5, 4, 0).view()),
                           Bound::exact(), {}};
    AccuracyRow bad = good, lost = good;
    bad.error = errorOf(grey(5, 4, 0).view(), grey(5, 4, 1).view());
    lost.error = {};
    lost.failure = "why it was";
    const auto statusOf = [](const std::vector<AccuracyRow>& rows) {
        return AccuracyReport{"scenes", "", rows}.exitStatus();
    };
    EXPECT_EQ(statusOf({good, good}), 0);
    EXPECT_EQ(statusOf({good, bad}), 1);
    EXPECT_EQ(statusOf({good, lost}), 1);
    EXPECT_EQ(statusOf({bad, lost}), 1);
    EXPECT_EQ(statusOf({lost, lost}), 2);
    EXPECT_EQ(statusOf({}), 2);
    EXPECT_NE(tableOf({"scenes", "", {lost, lost}}).find("\n0 measured, 0 broken, 2 failed\n"), std::string::npos);
}

TEST(AccuracyReport, formatsReadableNumbers) {
    EXPECT_EQ(spaced(0), "0");
    EXPECT_EQ(spaced(999), "999");
    EXPECT_EQ(spaced(1000), "1 000");
    EXPECT_EQ(spaced(-1234567), "-1 234 567");
}

} // namespace
} // namespace mural::cli
