// The overlay of a complete head, through the control interface, with nodes and programs without GL.
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "tests/head/support/controlled_session.hpp"
#include "tests/head/support/fake_sink.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

template <class Condition> bool eventually(Condition condition) {
    const Deadline deadline = Deadline::inMs(kTestPatienceMs);
    while (!condition() && !deadline.passed()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return condition();
}

// Returns the arguments of the latest command of this kind that the node has received; empty: none.
std::vector<uint32_t> latest(const FakeNode& node, wire::HeadCommand command) {
    std::vector<uint32_t> found;
    for (const FakeNode::Packet& packet : node.packets())
        if (packet.stream == 0 && packet.words.at(0) == static_cast<uint32_t>(command))
            found.assign(packet.words.begin() + 1, packet.words.end());
    return found;
}

class SessionOverlay : public ::testing::Test {
protected:
    void open() {
        head_.open();
        ASSERT_TRUE(program_.connect(head_.config.session));
        head_.waitFor("clients");
    }
    bool swap(uint32_t frame) {
        return program_.publish(kFakeSwap, {frame, 5, 64, 48}) && program_.waitFramesDone(frame);
    }
    bool receive(const std::vector<uint32_t>& modes) {
        return eventually([&] {
            return latest(head_.node(0), wire::HeadCommand::Overlay) == modes &&
                   latest(head_.node(1), wire::HeadCommand::Overlay) == modes;
        });
    }

    ControlledSession head_{2};
    FakeProgram program_;
};

TEST_F(SessionOverlay, reachesNodesOfAProgramThatDrawsNothing) {
    open();
    EXPECT_EQ(head_.request("overlay")["result"]["overlay"], "off");
    const Json all = head_.request("overlay", {{"mode", "grid"}})["result"];
    EXPECT_EQ(all, (Json{{"overlay", "grid"},
                         {"nodes", {{{"node", 0}, {"overlay", "grid"}}, {{"node", 1}, {"overlay", "grid"}}}}}));
    EXPECT_TRUE(receive({3, 3}));
    const Json one = head_.request("overlay", {{"mode", "names"}, {"node", 1}})["result"];
    EXPECT_EQ(one["overlay"], "grid");
    EXPECT_EQ(one["nodes"][1]["overlay"], "names");
    EXPECT_TRUE(receive({3, 2}));
    EXPECT_EQ(head_.request("overlay")["result"], one);
    EXPECT_EQ(head_.request("overlay", {{"mode", "off"}})["result"]["nodes"][1]["overlay"], "off");
    EXPECT_TRUE(receive({0, 0}));
    head_.finish();
}

TEST_F(SessionOverlay, isRefusedWithTheValidValues) {
    open();
    for (const Json& arguments : {Json{{"mode", "gird"}}, Json{{"mode", ""}}, Json{{"mode", "grid"}, {"node", 2}},
                                  Json{{"mode", "grid"}, {"node", -1}}, Json{{"node", 1}}}) {
        const Json reply = head_.request("overlay", arguments);
        EXPECT_EQ(reply["code"], "failed") << reply;
        EXPECT_EQ(reply.value("error", std::string()).find('\n'), std::string::npos);
    }
    EXPECT_NE(
        head_.request("overlay", {{"mode", "gird"}}).value("error", std::string()).find("off, stats, names or grid"),
        std::string::npos);
    EXPECT_EQ(head_.request("overlay", {{"mode", 3}})["code"], "bad-argument");
    EXPECT_EQ(head_.request("overlay")["result"]["overlay"], "off");
    head_.finish();
}

TEST_F(SessionOverlay, beginsWithTheSession) {
    head_.config.overlay = OverlayMode::Names;
    open();
    EXPECT_EQ(head_.request("overlay")["result"]["nodes"][1]["overlay"], "names");
    const std::vector<uint32_t> setup = latest(head_.node(1), wire::HeadCommand::Setup);
    const std::string text(reinterpret_cast<const char*>(setup.data()), setup.size() * sizeof setup[0]);
    EXPECT_NE(text.find(R"("overlay":"names")"), std::string::npos);
    head_.finish();
}

TEST_F(SessionOverlay, requestsStatisticsOnlyForStats) {
    open();
    for (const char* mode : {"names", "grid"}) EXPECT_EQ(head_.request("overlay", {{"mode", mode}})["ok"], true);
    ASSERT_TRUE(receive({3, 3}));
    std::this_thread::sleep_for(std::chrono::milliseconds(900)); // two turns of the numbers
    ASSERT_TRUE(swap(1));
    EXPECT_TRUE(latest(head_.node(0), wire::HeadCommand::Statistics).empty());
    EXPECT_EQ(head_.request("overlay", {{"mode", "stats"}})["ok"], true);
    uint32_t frame = 1;
    EXPECT_TRUE(eventually([&] {
        EXPECT_TRUE(swap(++frame));
        return latest(head_.node(0), wire::HeadCommand::Statistics) == std::vector<uint32_t>{1};
    }));
    head_.finish();
}

TEST_F(SessionOverlay, isInTheProgramsWindowButNotInFiles) {
    Shown shown;
    addSinks(head_, shown);
    head_.config.display = Display::App;
    open();
    const auto pixelsOf = [&](const std::string& sink) {
        const std::lock_guard lock(shown.mutex);
        const auto& all = shown.pixels[sink];
        return all.empty() ? std::vector<uint32_t>() : all.back();
    };
    ASSERT_TRUE(swap(1));
    ASSERT_TRUE(program_.waitFramesShown(1));
    std::string window;
    {
        const std::lock_guard lock(shown.mutex);
        for (const auto& [name, frames] : shown.frames)
            if (name != "file") window = name;
    }
    const std::vector<uint32_t> plain = pixelsOf(window);
    ASSERT_FALSE(plain.empty());
    EXPECT_EQ(plain, pixelsOf("file"));
    for (const char* mode : {"grid", "names"}) {
        EXPECT_EQ(head_.request("overlay", {{"mode", mode}})["ok"], true);
        EXPECT_TRUE(eventually([&] { return pixelsOf(window) != plain; })) << mode; // without a further frame
        EXPECT_EQ(head_.request("overlay", {{"mode", "off"}})["ok"], true);
        EXPECT_TRUE(eventually([&] { return pixelsOf(window) == plain; })) << mode;
    }
    EXPECT_EQ(head_.request("overlay", {{"mode", "grid"}})["ok"], true);
    for (uint32_t frame = 2; frame <= 6; ++frame) {
        ASSERT_TRUE(swap(frame));
        ASSERT_TRUE(program_.waitFramesShown(frame));
        EXPECT_NE(pixelsOf(window), pixelsOf("file"));
    }
    EXPECT_EQ(pixelsOf("file").size(), plain.size());
    // A program that reads its windows finds no overlay.
    program_.header()->readsWindows = 1;
    EXPECT_TRUE(eventually([&] { return program_.header()->overlayShown == 0; }));
    EXPECT_EQ(pixelsOf(window), pixelsOf("file"));
    ASSERT_TRUE(swap(7));
    ASSERT_TRUE(program_.waitFramesShown(7));
    EXPECT_EQ(pixelsOf(window), pixelsOf("file"));
    EXPECT_EQ(program_.header()->overlayShown.load(), 0U);
    head_.finish();
}

} // namespace
} // namespace mural
