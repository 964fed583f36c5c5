// Changes to a running session through the control interface, with nodes and programs without GL.
#include <gtest/gtest.h>

#include <filesystem>
#include <future>

#include "streamcodec/trace/trace_reader.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"
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
        EXPECT_NE(reply.value("error", std::string()).find("0 to 64"), std::string::npos) << reply;
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

// A session whose nodes could be restarted, with one program that has shown frames in real records.
class RecordedSession : public ControlledSession {
public:
    explicit RecordedSession(int nodes) : ControlledSession(nodes) {
        options.startNode = [](const NodePlan&) { return Result<StartingNode>(Error{"no node"}); };
    }
    bool connectProgram() {
        open();
        if (!program.connect(config.session)) return false;
        waitFor("clients");
        wire::WindowConfig window{};
        window.width = 64;
        window.height = 48;
        std::vector<uint32_t> words(1 + sizeof window / 4, 1);
        std::memcpy(words.data() + 1, &window, sizeof window);
        return record(wire::kOpWindow, words);
    }
    bool record(uint16_t opcode, const std::vector<uint32_t>& arguments) {
        std::vector<uint32_t> words{opcode | static_cast<uint32_t>(arguments.size() + 1) << 16};
        words.insert(words.end(), arguments.begin(), arguments.end());
        return program.publishWords(words);
    }
    bool swap(uint32_t frame) { return record(wire::kOpSwap, {1, frame}); }
    std::string file() const { return folder.at("a.mural"); }

    FakeProgram program;
    test::TemporaryFolder folder;
};

TEST(SessionChanges, recordFromTheNextFrameOn) {
    RecordedSession head(2);
    ASSERT_TRUE(head.connectProgram());
    for (uint32_t frame = 1; frame <= 4; ++frame) ASSERT_TRUE(head.swap(frame));
    ASSERT_TRUE(passed(head.program));
    EXPECT_EQ(head.request("status")["result"]["recording"], Json());
    const Json begun = head.request("record-start", {{"file", head.file()}});
    EXPECT_EQ(begun["result"]["firstFrame"], 5) << begun;
    const Json again = head.request("record-start", {{"file", head.file()}});
    EXPECT_NE(again.value("error", std::string()).find("record stop"), std::string::npos) << again;
    EXPECT_EQ(head.request("status")["result"]["recording"]["file"], head.file());
    for (uint32_t frame = 5; frame <= 7; ++frame) ASSERT_TRUE(head.swap(frame));
    ASSERT_TRUE(passed(head.program));
    const Json ended = head.request("record-stop")["result"];
    EXPECT_EQ(ended["frames"], 3) << ended;
    EXPECT_EQ(ended["complete"], true);
    EXPECT_EQ(ended["bytes"], std::filesystem::file_size(head.file()));
    ASSERT_TRUE(head.swap(8)); // not recorded
    ASSERT_TRUE(passed(head.program));
    EXPECT_EQ(head.request("record-stop")["ok"], false);
    const auto report = head.finish();
    EXPECT_EQ(report["recording"], head.file());
    EXPECT_EQ(report["recordedFrames"], 3);
    auto reader = trace::TraceReader::open(head.file());
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ((*reader)->frames(), 3);
}

TEST(SessionChanges, completeARecordingAtTheEnd) {
    RecordedSession head(2);
    ASSERT_TRUE(head.connectProgram());
    ASSERT_TRUE(head.swap(1));
    ASSERT_TRUE(passed(head.program));
    ASSERT_EQ(head.request("record-start", {{"file", head.file()}})["ok"], true);
    ASSERT_TRUE(head.swap(2));
    ASSERT_TRUE(passed(head.program));
    EXPECT_EQ(head.finish()["recordedFrames"], 1);
    auto reader = trace::TraceReader::open(head.file());
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ((*reader)->notice(), "");
}

TEST(SessionChanges, refuseARecordingThatWouldNotPlay) {
    RecordedSession one(1);
    one.open();
    const Json copies = one.request("record-start", {{"file", one.file()}});
    EXPECT_NE(copies.value("error", std::string()).find("two nodes"), std::string::npos) << copies;
    one.finish();
    ControlledSession stateless(2); // its nodes are not restarted
    stateless.open();
    const Json state = stateless.request("record-start", {{"file", one.file()}});
    EXPECT_NE(state.value("error", std::string()).find("--restart-nodes"), std::string::npos) << state;
    stateless.finish();
    RecordedSession unwritable(2);
    unwritable.open();
    const Json place = unwritable.request("record-start", {{"file", "/nowhere/a.mural"}});
    EXPECT_NE(place.value("error", std::string()).find("cannot be written"), std::string::npos) << place;
    EXPECT_EQ(unwritable.request("record-start", {{"file", unwritable.file()}})["ok"], true);
    unwritable.finish();
    EXPECT_TRUE(std::filesystem::exists(unwritable.file()));
    EXPECT_FALSE(std::filesystem::exists(one.file()));
}

// Draws frames until the reply has arrived, and returns it. `frame` is the last one.
Json drawDuring(std::future<Json>& reply, FakeProgram& program, uint32_t& frame) {
    const Deadline deadline = Deadline::inMs(kTestPatienceMs);
    while (reply.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready && !deadline.passed())
        if (!swapFrame(program, ++frame) || !passed(program)) return {};
    return reply.get();
}

TEST(SessionChanges, stopANodeWhoseTilesOthersTake) {
    ControlledSession head(3);
    head.config.tileWidth = head.config.tileHeight = 16;
    head.open();
    EXPECT_EQ(head.request("subscribe", {{"topic", "events"}, {"interval", 20}})["ok"], true);
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    uint32_t frame = 1;
    ASSERT_TRUE(swapFrame(program, frame) && passed(program));
    auto reply = std::async(std::launch::async, [&] { return head.request("stop-node", {{"node", 1}}); });
    const Json stopped = drawDuring(reply, program, frame);
    EXPECT_EQ(stopped["ok"], true) << stopped;
    EXPECT_EQ(head.request("nodes")["result"]["nodes"][1]["state"], "stopped");
    ASSERT_TRUE(swapFrame(program, ++frame));
    EXPECT_TRUE(program.waitFramesDone(frame)); // without the node
    EXPECT_EQ(head.request("stop-node", {{"node", 1}})["code"], "failed");
    const Json start = head.request("start-node", {{"node", 1}});
    EXPECT_NE(start.value("error", std::string()).find("--restart-nodes"), std::string::npos) << start;
    const auto report = head.finish();
    EXPECT_EQ(report["nodes"][1]["lost"], false) << report["nodes"];
}

TEST(SessionChanges, keepANodeWhosePartDoesNotMove) {
    ControlledSession head(3);
    head.config.tileWidth = head.config.tileHeight = 16;
    head.open();
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    ASSERT_TRUE(swapFrame(program, 1) && passed(program));
    const Json idle = head.request("stop-node", {{"node", 1}}); // no frame is drawn meanwhile
    EXPECT_EQ(idle["code"], "failed");
    EXPECT_NE(idle.value("error", std::string()).find("programs draw nothing"), std::string::npos) << idle;
    EXPECT_EQ(head.request("nodes")["result"]["nodes"][1]["state"], "alive");
    ASSERT_TRUE(swapFrame(program, 2));
    EXPECT_TRUE(program.waitFramesDone(2));
    head.finish();
    ControlledSession fixed(2);
    fixed.open();
    const Json refused = fixed.request("stop-node", {{"node", 1}});
    EXPECT_NE(refused.value("error", std::string()).find("force"), std::string::npos) << refused;
    EXPECT_EQ(fixed.request("start-node", {{"node", 1}})["code"], "failed");
    fixed.finish();
}

// The node has all frames of the stream before its last message, even those that it has not read yet.
TEST(SessionChanges, awaitAllFramesBeforeTheStop) {
    Shown shown;
    ControlledSession head(2);
    addSinks(head, shown);
    std::atomic<bool> isPaused{false};
    head.behaviours[1].isPaused = &isPaused;
    head.open();
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    ASSERT_TRUE(swapFrame(program, 1) && passed(program));
    const Deadline shownBy = Deadline::inMs(kTestPatienceMs);
    while (shown.count("file") == 0 && !shownBy.passed()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(shown.count("file"), 1U);
    isPaused = true;
    for (uint32_t frame = 2; frame <= 6; ++frame) ASSERT_TRUE(swapFrame(program, frame));
    const Deadline sent = Deadline::inMs(kTestPatienceMs); // node 0 has them
    while (head.node(0).packets().back().words != std::vector<uint32_t>{6, kFakeSwap, 6, 5, 64, 48} && !sent.passed())
        std::this_thread::yield();
    auto reply = std::async(std::launch::async, [&] {
        return head.request("stop-node", {{"node", 1}, {"force", true}});
    });
    EXPECT_EQ(reply.wait_for(std::chrono::milliseconds(300)), std::future_status::timeout);
    EXPECT_EQ(shown.count("file"), 1U); // the later frames lack its part
    isPaused = false;
    EXPECT_EQ(reply.get()["ok"], true);
    ASSERT_TRUE(swapFrame(program, 7));
    EXPECT_TRUE(program.waitFramesDone(7));
    head.finish();
    ASSERT_EQ(shown.pixels["file"].size(), 7U);
    for (uint32_t frame = 1; frame <= 7; ++frame) {
        const auto& pixels = shown.pixels["file"][frame - 1];
        EXPECT_EQ(pixels[0], frame << 8);
        EXPECT_EQ(pixels[63], std::min(frame, 6U) << 8 | 1) << frame;
    }
}

} // namespace
} // namespace mural
