// Parameters of equalizers: types, limits, errors.
#include <gtest/gtest.h>

#include "balancer/equalizers/parameters.hpp"

namespace mural::balance {
namespace {

Parameters some() {
    Parameters p;
    p.addNumber("damping", .5, 0, 1);
    p.addNumber("framerate", 10, .01, 1000, "Hz");
    p.addPixels("boundary", {1, 1});
    p.addWord("mode", "2D", {"2D", "DB"});
    return p;
}

TEST(Parameters, acceptValuesWithinTheLimits) {
    Parameters p = some();
    EXPECT_TRUE(p.set("damping", "0.25").ok());
    EXPECT_TRUE(p.set("boundary", "[16 8]").ok());
    EXPECT_TRUE(p.set("mode", "DB").ok());
    EXPECT_EQ(p.number("damping"), .25);
    EXPECT_EQ(p.pixels("boundary"), (PixelStep{16, 8}));
    EXPECT_EQ(p.word("mode"), "DB");
    EXPECT_EQ(p.version(), 3u);
    EXPECT_EQ(textOf(p.find("boundary")->value), "16 8");
}

TEST(Parameters, refuseOtherValuesAndKeepTheOldOnes) {
    Parameters p = some();
    const auto error = [&](const char* name, const char* value) {
        const auto result = p.set(name, value);
        return result.ok() ? std::string("accepted") : result.error().message;
    };
    EXPECT_EQ(error("damping", "1.5"), "damping must be 0 to 1, not \"1.5\"");
    EXPECT_EQ(error("damping", "nan"), "damping must be 0 to 1, not \"nan\"");
    EXPECT_EQ(error("damping", ""), "damping must be 0 to 1, not \"\"");
    EXPECT_EQ(error("damping", "0.5x"), "damping must be 0 to 1, not \"0.5x\"");
    EXPECT_EQ(error("framerate", "0"), "framerate must be 0.01 to 1000 Hz, not \"0\"");
    EXPECT_EQ(error("boundary", "16"), "boundary must be two numbers, each 0 to 1048576 px, not \"16\"");
    EXPECT_EQ(error("mode", "3D"), "mode must be 2D or DB, not \"3D\"");
    EXPECT_EQ(error("speed", "1"), "there is no parameter \"speed\"; there are damping, framerate, boundary, mode");
    EXPECT_EQ(p.number("damping"), .5);
    EXPECT_EQ(p.version(), 0u);
}

TEST(Parameters, moveValuesOfFilesToTheNearestLimit) {
    Parameters p;
    p.addNumber("damping", 7, 0, 1);
    EXPECT_EQ(p.number("damping"), 1);
}

} // namespace
} // namespace mural::balance
