// Changes to a running session through the control interface, with nodes and programs without GL.
#include <gtest/gtest.h>

#include "tests/head/support/controlled_session.hpp"
#include "tests/head/support/fake_sink.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

bool swapFrame(FakeProgram& program, uint32_t frame, uint32_t window = 5) {
    return program.publish(kFakeSwap, {frame, window, 64, 48});
}

// Blocks until the nodes have passed everything that the program has published.
bool passed(FakeProgram& program) {
    FakeProgram::Answer answer;
    return program.publish(kFakeSum, {77}) && program.readAnswer(answer);
}

TEST(SessionChanges, changeTheLatencyOfCurrentAndLaterPrograms) {
    ControlledSession head(2);
    head.config.latency = 2;
    head.open();
    FakeProgram early;
    ASSERT_TRUE(early.connect(head.config.session));
    head.waitFor("clients");
    EXPECT_EQ(early.header()->latency.load(), 2U);
    EXPECT_EQ(head.request("latency")["result"]["latency"], 2);
    EXPECT_EQ(head.request("status")["result"]["latency"], 2);
    EXPECT_EQ(head.request("latency", {{"frames", 7}})["result"]["latency"], 7);
    EXPECT_EQ(early.header()->latency.load(), 7U);
    FakeProgram late;
    ASSERT_TRUE(late.connect(head.config.session));
    EXPECT_EQ(late.header()->latency.load(), 7U);
    EXPECT_EQ(head.request("status")["result"]["latency"], 7);
    head.finish();
}

TEST(SessionChanges, refuseALatencyOutOfRange) {
    ControlledSession head(1);
    head.open();
    for (const int frames : {-1, 65}) {
        const Json reply = head.request("latency", {{"frames", frames}});
        EXPECT_EQ(reply["code"], "failed") << reply;
        EXPECT_NE(reply["error"].get<std::string>().find("0 to 64"), std::string::npos) << reply;
    }
    EXPECT_EQ(head.request("latency", {{"frames", "2"}})["code"], "bad-argument");
    EXPECT_EQ(head.request("latency")["result"]["latency"], 1);
    head.finish();
}

TEST(SessionChanges, letTheCreditWaitForTheProgramsWindowOnlyWithoutLatency) {
    Shown shown;
    ControlledSession head(1);
    addSinks(head, shown);
    head.config.display = Display::App;
    head.config.latency = 0;
    head.open();
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    shown.block(true);
    ASSERT_TRUE(swapFrame(program, 1));
    ASSERT_TRUE(passed(program));
    EXPECT_EQ(program.header()->framesDone.load(), 0U);
    EXPECT_EQ(head.request("latency", {{"frames", 1}})["ok"], true);
    EXPECT_EQ(program.header()->framesDone.load(), 1U); // at once, without another frame
    ASSERT_TRUE(swapFrame(program, 2));
    ASSERT_TRUE(program.waitFramesDone(2));
    EXPECT_EQ(head.request("latency", {{"frames", 0}})["ok"], true);
    EXPECT_EQ(program.header()->framesDone.load(), 0U);
    shown.block(false);
    EXPECT_TRUE(program.waitFramesDone(2));
    EXPECT_TRUE(program.waitFramesShown(2));
    head.finish();
}

} // namespace
} // namespace mural
