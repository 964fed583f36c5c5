#include <cmath>

#include <gtest/gtest.h>

#include "examples/base/arguments.hpp"
#include "examples/base/turning.hpp"

namespace mural::examples {
namespace {

Arguments argumentsOf(std::vector<std::string> words) {
    words.insert(words.begin(), "program");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    return {static_cast<int>(argv.size()), argv.data()};
}

TEST(Arguments, takesOptionsInAnyOrder) {
    Arguments arguments = argumentsOf({"a.ply", "--report", "--frames", "5", "--colour", "ff0000", "b.ply"});
    EXPECT_EQ(arguments.takeNumber("--frames", 0, 1, 100), 5);
    EXPECT_EQ(arguments.takeText("--colour"), "ff0000");
    EXPECT_TRUE(arguments.takeFlag("--report"));
    EXPECT_FALSE(arguments.takeFlag("--report"));
    EXPECT_EQ(arguments.takeNumber("--pitch", 7, -180, 180), 7);
    const auto files = arguments.finish();
    ASSERT_TRUE(files) << files.error().message;
    EXPECT_EQ(files.value(), (std::vector<std::string>{"a.ply", "b.ply"}));
}

TEST(Arguments, reportsFirstProblem) {
    const auto problem = [](const std::vector<std::string>& words) {
        Arguments arguments = argumentsOf(words);
        arguments.takeNumber("--frames", 0, 1, 100);
        arguments.takeText("--colour");
        const auto files = arguments.finish();
        return files ? "none" : files.error().message;
    };
    EXPECT_EQ(problem({"--frames", "0"}), "--frames needs a number from 1 to 100, not \"0\"; --help lists the options");
    EXPECT_EQ(problem({"--frames", "5x"}),
              "--frames needs a number from 1 to 100, not \"5x\"; --help lists the options");
    EXPECT_EQ(problem({"--frames", "nan"}),
              "--frames needs a number from 1 to 100, not \"nan\"; --help lists the options");
    EXPECT_EQ(problem({"--colour"}), "--colour needs a value; --help lists the options");
    EXPECT_EQ(problem({"--fast"}), "there is no option --fast; --help lists the options");
}

TEST(Arguments, parsesColours) {
    EXPECT_EQ(parseColour("ff0033").value(), (std::array<float, 3>{1, 0, .2f}));
    for (const char* text : {"", "ff00", "ff00zz", "+f0000", "#ff0000"}) EXPECT_FALSE(parseColour(text)) << text;
}

TEST(Placement, hasInverse) {
    const Placement placement(30, -20, {1, 2, 3}, .25);
    const Vector3 p = transformPoint(placement.fromRoom, transformPoint(placement.toRoom, {4, 5, 6}));
    EXPECT_NEAR(p.x, 4, 1e-9);
    EXPECT_NEAR(p.y, 5, 1e-9);
    EXPECT_NEAR(p.z, 6, 1e-9);
    const Vector3 centre = transformPoint(placement.toRoom, {1, 2, 3});
    EXPECT_NEAR(centre.z, -kObjectDistance, 1e-9);
    EXPECT_NEAR(length(transformDirection(placement.toRoom, {.25, 0, 0})), kObjectRadius, 1e-9);
}

} // namespace
} // namespace mural::examples
