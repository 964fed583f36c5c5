// The complete head, with fake nodes and fake programs.
#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"
#include "tests/head/support/session_harness.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

bool swapFrames(FakeProgram& program, uint32_t from, uint32_t to, uint32_t width = 64, uint32_t height = 48) {
    for (uint32_t frame = from; frame <= to; ++frame)
        if (!program.publish(kFakeSwap, {frame, 1, width, height})) return false;
    return true;
}

size_t swapsOf(FakeNode& node) {
    size_t swaps = 0;
    for (const auto& packet : node.packets())
        for (size_t at = 0; packet.stream != 0 && at + 1 < packet.words.size(); at += packet.words[at])
            swaps += packet.words[at + 1] == kFakeSwap ? 1 : 0;
    return swaps;
}

std::vector<uint32_t> notesOf(FakeNode& node, uint32_t stream) {
    std::vector<uint32_t> notes;
    for (const auto& packet : node.packets())
        if (packet.stream == stream && packet.words[1] == kFakeNote) notes.push_back(packet.words[2]);
    return notes;
}

TEST(HeadSession, announcesCommonFeaturesOfAllNodes) {
    SessionHarness head(3);
    head.config.latency = 2;
    head.config.verifyEvery = 5;
    head.config.localRendering = LocalRendering::On;
    head.start();
    const auto ready = head.waitFor("ready");
    EXPECT_EQ(ready["nodes"].size(), 3u);
    EXPECT_EQ(ready["nodes"][1]["where"], "local");
    EXPECT_EQ(ready["nodes"][1]["gl"], "fake");
    EXPECT_GE(ready["explain"].size(), 4u); // a region per node, the tiling
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    EXPECT_EQ(head.waitFor("clients")["count"], 1);
    EXPECT_EQ(program.welcome().refused, 0u);
    EXPECT_EQ(program.welcome().nodeCount, 3u);
    EXPECT_EQ(program.header()->latency.load(), 2u);
    EXPECT_EQ(program.welcome().verifyEvery, 5u);
    EXPECT_EQ(program.welcome().localRendering, capture::kLocalRenderingOn);
    EXPECT_EQ(program.welcome().nodeGlVersion, 40u);
    EXPECT_EQ(program.text(), "GL_COMMON");
    head.finish();
    EXPECT_EQ(head.status(), 0);
}

TEST(HeadSession, reportsDriverEventsToTheProgramOnce) {
    SessionHarness head(3);
    for (auto& behaviour : head.behaviours) behaviour.driverMessage = "a slow draw" + std::string(600, '.');
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    ASSERT_TRUE(swapFrames(program, 1, 2));
    ASSERT_TRUE(program.waitFramesDone(2));
    ASSERT_EQ(program.header()->driverEventTail.load(), 2u); // from three nodes
    wire::DriverEvent event{};
    const capture::DriverEventSlot& slot = capture::driverEvents(program.header())[1];
    std::memcpy(&event, slot.event, sizeof event);
    EXPECT_EQ(event.context, 7u);
    EXPECT_EQ(event.textBytes, capture::kDriverEventTextBytes); // long texts are truncated
    EXPECT_EQ(std::string(slot.text, 11), "a slow draw");
    // A program that never reads events: they are lost, and frames continue.
    ASSERT_TRUE(swapFrames(program, 3, 100));
    ASSERT_TRUE(program.waitFramesDone(100));
    EXPECT_EQ(program.header()->driverEventTail.load(), capture::kDriverEventSlots);
    head.finish();
    EXPECT_EQ(head.status(), 0);
}

TEST(HeadSession, sendsEveryPacketToEveryNodeInOrder) {
    SessionHarness head(3);
    head.start();
    head.waitFor("ready");
    FakeProgram a;
    FakeProgram b;
    ASSERT_TRUE(a.connect(head.config.session));
    ASSERT_TRUE(b.connect(head.config.session));
    constexpr uint32_t kNotes = 300; // more than the ring has chunks
    for (uint32_t i = 0; i < kNotes; ++i) {
        ASSERT_TRUE(a.publish(kFakeNote, {i}, 0));
        ASSERT_TRUE(a.publish(kFakeNote, {i}, 3));
        ASSERT_TRUE(b.publish(kFakeNote, {i}, 0));
    }
    const auto report = head.finish();
    std::vector<uint32_t> expected(kNotes);
    for (uint32_t i = 0; i < kNotes; ++i) expected[i] = i;
    for (int node = 0; node < 3; ++node) {
        EXPECT_EQ(notesOf(head.node(node), wire::streamOf(a.welcome().clientId, 0)), expected);
        EXPECT_EQ(notesOf(head.node(node), wire::streamOf(a.welcome().clientId, 3)), expected);
        EXPECT_EQ(notesOf(head.node(node), wire::streamOf(b.welcome().clientId, 0)), expected);
        // Not only within each stream: the total order is equal on all nodes.
        const auto first = head.node(0).packets();
        const auto mine = head.node(node).packets();
        ASSERT_EQ(first.size(), mine.size());
        for (size_t i = 1; i < mine.size(); ++i) EXPECT_EQ(first[i].words, mine[i].words);
        EXPECT_EQ(mine.back().words[0], static_cast<uint32_t>(wire::HeadCommand::Finish));
    }
    EXPECT_EQ(report["calls"], 42);
    EXPECT_EQ(report["nodes"][2]["lost"], false);
}

TEST(HeadSession, givesCreditOnlyWhenAllNodesAreDone) {
    std::atomic<bool> isPaused{false};
    SessionHarness head(2);
    head.behaviours[1].isPaused = &isPaused;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    isPaused = true;
    ASSERT_TRUE(swapFrames(program, 1, 40));
    const Deadline deadline = Deadline::inMs(kTestPatienceMs);
    while (swapsOf(head.node(0)) < 40 && !deadline.passed()) std::this_thread::yield();
    EXPECT_EQ(swapsOf(head.node(0)), 40u);
    EXPECT_EQ(program.header()->framesDone.load(), 0u);
    isPaused = false;
    EXPECT_TRUE(program.waitFramesDone(40));
    EXPECT_EQ(program.header()->framesDone.load(), 40u);
    const auto report = head.finish();
    EXPECT_EQ(report["frames"], 40);
    EXPECT_EQ(report["nodes"][0]["frames"], 40);
    EXPECT_TRUE(program.waitHeadGone());
}

TEST(HeadSession, blocksTheProgramForASlowNode) {
    std::atomic<bool> isPaused{false};
    SessionHarness head(2);
    head.pipeBytes = 4096;
    head.behaviours[1].isPaused = &isPaused;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    ASSERT_TRUE(swapFrames(program, 1, 1));
    ASSERT_TRUE(program.waitFramesDone(1));
    isPaused = true;
    // More bytes than the pipe and all chunks hold: the publisher must block until the node reads again.
    std::atomic<bool> done{false};
    std::thread publisher([&] {
        std::vector<uint32_t> words(2000, 0);
        words[0] = 2000;
        words[1] = kFakeNote;
        for (int i = 0; i < 40; ++i)
            if (!program.publishWords(words)) return;
        done = true;
    });
    while (program.header()->freedTail.load() == program.header()->freedHead.load() ? false : !done) {
        std::this_thread::yield(); // until all chunks are in use
    }
    EXPECT_FALSE(done);
    EXPECT_EQ(program.header()->framesDone.load(), 1u);
    isPaused = false;
    publisher.join();
    EXPECT_TRUE(done);
    ASSERT_TRUE(swapFrames(program, 2, 2));
    EXPECT_TRUE(program.waitFramesDone(2));
    head.finish();
}

// As after `kill -STOP`: the node's silence is the only sign.
TEST(HeadSession, dropsASilentNodeAndContinues) {
    std::atomic<bool> isPaused{false};
    SessionHarness head(2);
    head.options.silencePatienceMs = 1500;
    head.behaviours[0].alive = true; // idle nodes send a heartbeat
    head.behaviours[1].alive = true;
    head.behaviours[1].isPaused = &isPaused;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    ASSERT_TRUE(swapFrames(program, 1, 1));
    ASSERT_TRUE(program.waitFramesDone(1));
    isPaused = true;
    ASSERT_TRUE(swapFrames(program, 2, 3));
    ASSERT_TRUE(program.publish(kFakeSum, {5}));
    FakeProgram::Answer answer;
    EXPECT_TRUE(program.readAnswer(answer));
    EXPECT_TRUE(program.waitFramesDone(3));
    const std::string line = head.waitForMessage("was lost");
    EXPECT_EQ(line.rfind("node 1 (local) was lost: no message for", 0), 0u) << line;
    const auto report = head.finish();
    EXPECT_EQ(report["nodes"][0]["lost"], false);
    EXPECT_EQ(report["nodes"][1]["lost"], true);
    isPaused = false;
}

TEST(HeadSession, endsWithTheReasonOfANodesRefusal) {
    SessionHarness head(2);
    head.behaviours[1].refuses = true;
    head.start();
    const auto error = head.waitFor("error");
    EXPECT_EQ(error["text"], "node 1 (local) did not start: another build");
    for (const auto& event : head.seen) EXPECT_NE(event["event"], "say") << event;
}

TEST(HeadSession, reportsWindowsThatEveryNodeDrawsWholeOnce) {
    SessionHarness head(2);
    for (auto& behaviour : head.behaviours) behaviour.drawsWhole = true;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    ASSERT_TRUE(swapFrames(program, 1, 3));
    ASSERT_TRUE(program.waitFramesDone(3));
    const auto report = head.finish();
    EXPECT_EQ(report["drawnWhole"], true);
    ASSERT_EQ(report["limits"].size(), 1u);
    EXPECT_EQ(report["limits"][0]["code"], "drawn-whole");
    EXPECT_TRUE(report["sharedDraws"].is_null());
    int line = 0;
    for (const auto& event : head.seen)
        line += event["event"] == "say" &&
                event["text"].get<std::string>().find("every node draws the whole picture") != std::string::npos;
    EXPECT_EQ(line, 1);
}

// Slower nodes receive less, and all nodes receive the change at the same place of the stream.
TEST(HeadSession, movesQueuedTilesOnAllNodesAtOnce) {
    SessionHarness head(3);
    head.config.tileWidth = head.config.tileHeight = 4;
    head.behaviours[0].busyNs = 9'000'000;
    head.behaviours[1].busyNs = 1'000'000;
    head.behaviours[2].busyNs = 1'000'000;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    for (uint32_t frame = 1; frame <= 30; ++frame) {
        ASSERT_TRUE(swapFrames(program, frame, frame));
        ASSERT_TRUE(program.waitFramesDone(frame));
    }
    const auto report = head.finish();
    ASSERT_EQ(report["equalizers"].size(), 1u);
    const auto& queue = report["equalizers"][0];
    EXPECT_EQ(queue["kind"], "tile_queue");
    EXPECT_GT(queue["moves"], 0);
    EXPECT_LT(queue["nodes"][0]["part"], queue["nodes"][1]["part"]);
    int announced = 0;
    std::vector<std::pair<uint32_t, std::vector<uint32_t>>> first; // all commands except setups
    for (int node = 0; node < 3; ++node) {
        std::vector<std::pair<uint32_t, std::vector<uint32_t>>> packets;
        for (const auto& packet : head.node(node).packets()) {
            if (packet.stream == 0 && packet.words[0] == static_cast<uint32_t>(wire::HeadCommand::Setup)) continue;
            packets.emplace_back(packet.stream, packet.words);
            announced += node == 0 && packet.stream == 0 &&
                         packet.words[0] == static_cast<uint32_t>(wire::HeadCommand::ViewportAssignment);
        }
        if (node == 0) first = packets;
        EXPECT_EQ(packets, first) << "node " << node;
    }
    EXPECT_GT(announced, 1);
}

TEST(HeadSession, sendsUnchangedAreasOnce) {
    SessionHarness head(2);
    head.config.tileWidth = head.config.tileHeight = 4;
    for (auto& behaviour : head.behaviours) behaviour.keepsAreas = true;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    ASSERT_TRUE(swapFrames(program, 1, 5));
    ASSERT_TRUE(program.waitFramesDone(5));
    head.waitForMessage("tiles of a window stay with their nodes");
    head.finish();
    EXPECT_EQ(std::ranges::count_if(head.seen,
                                    [](const auto& e) {
                                        return e["event"] == "say" &&
                                               e["text"].template get<std::string>().find("tiles of a window stay") !=
                                                   std::string::npos;
                                    }),
              1);
}

TEST(HeadSession, assemblesRepliesOfOneToFiveNodes) {
    for (int nodes = 1; nodes <= 5; ++nodes) {
        SessionHarness head(nodes);
        head.start();
        head.waitFor("ready");
        FakeProgram program;
        ASSERT_TRUE(program.connect(head.config.session));
        ASSERT_TRUE(program.publish(kFakePixels, {1, 5, 7, 50, 30}));
        ASSERT_TRUE(program.publish(kFakeBytes, {2}));
        ASSERT_TRUE(program.publish(kFakeSum, {3}));
        bool seen[4] = {};
        for (int i = 0; i < 3; ++i) {
            FakeProgram::Answer answer;
            ASSERT_TRUE(program.readAnswer(answer));
            ASSERT_LE(answer.header.requestId, 3u);
            seen[answer.header.requestId] = true;
            EXPECT_EQ(answer.header.failed, 0u);
            const auto* words = reinterpret_cast<const uint32_t*>(answer.bytes.data());
            if (answer.header.requestId == 1) {
                EXPECT_EQ(answer.header.x, 5);
                EXPECT_EQ(answer.header.y, 7);
                EXPECT_EQ(answer.header.w, 50);
                ASSERT_EQ(answer.header.h, 30);
                ASSERT_EQ(answer.bytes.size(), 50u * 30 * 4);
                for (uint32_t y = 0; y < 30; ++y)
                    for (uint32_t x = 0; x < 50; ++x)
                        ASSERT_EQ(words[y * 50 + x], (7 + y) * 1000 + 5 + x + 1) << x << ' ' << y;
            }
            if (answer.header.requestId == 2) {
                EXPECT_EQ(answer.bytes.size(), 12u);
            }
            if (answer.header.requestId == 3) {
                ASSERT_EQ(answer.bytes.size(), 16u);
                EXPECT_EQ(words[0], 10u * static_cast<uint32_t>(nodes));
                EXPECT_EQ(words[2], static_cast<uint32_t>(nodes * (nodes - 1) / 2));
            }
        }
        EXPECT_TRUE(seen[1] && seen[2] && seen[3]);
        head.finish();
    }
}

TEST(HeadSession, streamsAReplyLargerThanTheReplyRing) {
    SessionHarness head(2);
    head.pipeBytes = size_t{16} << 20;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    constexpr uint32_t kWords = 3 * capture::kReplyBytes / 4 + 5;
    ASSERT_TRUE(program.publish(kFakeBytes, {9, kWords}));
    FakeProgram::Answer answer;
    ASSERT_TRUE(program.readAnswer(answer));
    EXPECT_EQ(answer.header.sizeBytes, uint64_t{kWords} * 4);
    const auto* words = reinterpret_cast<const uint32_t*>(answer.bytes.data());
    for (uint32_t i = 0; i < kWords; ++i) ASSERT_EQ(words[i], 0x01020304u);
    head.finish();
}

TEST(HeadSession, rejectsOtherBuildsAndLatecomers) {
    SessionHarness head(1);
    head.start();
    head.waitFor("ready");
    FakeProgram other;
    ASSERT_TRUE(other.connect(head.config.session, kTestDigest + 1));
    EXPECT_EQ(other.welcome().refused, 1u);
    EXPECT_NE(other.text().find("different builds"), std::string::npos);
    EXPECT_EQ(other.header(), nullptr);
    FakeProgram right;
    ASSERT_TRUE(right.connect(head.config.session));
    EXPECT_EQ(right.welcome().refused, 0u);
    head.finish();
    FakeProgram late;
    EXPECT_FALSE(late.connect(head.config.session)); // the name ended with the session
}

struct Forgery {
    const char* name;
    std::function<void(FakeProgram&)> act;
};

TEST(HeadSession, dropsOnlyTheProgramWithAForgedRing) {
    const Forgery forgeries[] = {
        {"chunk",
         [](FakeProgram& p) {
             p.publishRaw({99999, 0, 64, 0, 0});
         }},
        {"begin after end",
         [](FakeProgram& p) {
             p.publishRaw({0, 64, 32, 0, 0});
         }},
        {"end",
         [](FakeProgram& p) {
             p.publishRaw({0, 0, capture::kChunkBytes + 4, 0, 0});
         }},
        {"odd",
         [](FakeProgram& p) {
             p.publishRaw({0, 0, 7, 0, 0});
         }},
        {"tail", [](FakeProgram& p) { p.header()->publishedTail = 0x7fffffff; }},
        {"tail back", [](FakeProgram& p) { p.header()->publishedTail = 0xffffffff; }},
        {"freed twice",
         [](FakeProgram& p) {
             p.publishRaw({0, 0, 0, 0, 1});
         }},
        {"offsets",
         [](FakeProgram& p) {
             p.header()->publicationsAt = ~0ull >> 1;
             p.header()->chunksAt = ~0ull >> 1;
             p.header()->freedAt = ~0ull >> 1;
             p.header()->chunkCount = 0x80000000;
             p.header()->publishedTail = 0x7fffffff;
         }},
    };
    SessionHarness head(2);
    head.start();
    head.waitFor("ready");
    FakeProgram honest;
    ASSERT_TRUE(honest.connect(head.config.session));
    for (const Forgery& forgery : forgeries) {
        FakeProgram program;
        ASSERT_TRUE(program.connect(head.config.session));
        forgery.act(program);
        EXPECT_TRUE(program.waitHeadGone()) << forgery.name;
        head.waitForMessage("program " + std::to_string(program.welcome().clientId) + " (");
    }
    ASSERT_TRUE(swapFrames(honest, 1, 3));
    EXPECT_TRUE(honest.waitFramesDone(3));
    EXPECT_EQ(head.finish()["frames"], 3);
}

TEST(HeadSession, drainsAnEndedProgramAndFreesItsContexts) {
    SessionHarness head(2);
    head.start();
    head.waitFor("ready");
    uint32_t id = 0;
    {
        FakeProgram program;
        ASSERT_TRUE(program.connect(head.config.session));
        id = program.welcome().clientId;
        program.header()->verifiedFrames = 3;
        program.header()->largestDifference = 9;
        program.header()->uncomparedFrames[static_cast<uint32_t>(capture::Uncompared::Front)] = 2;
        program.header()->uncomparedFrames[static_cast<uint32_t>(capture::Uncompared::NoAnswer)] = 1;
        ASSERT_TRUE(swapFrames(program, 1, 12));
        program.disconnect();
    }
    while (head.waitFor("clients")["count"] != 0) {}
    const auto report = head.finish();
    EXPECT_EQ(report["frames"], 12);
    EXPECT_EQ(report["verifiedFrames"], 3);
    EXPECT_EQ(report["largestDifference"], 9);
    EXPECT_EQ(report["uncomparedFrames"], 3);
    EXPECT_EQ(report["uncomparedFramesBy"], (nlohmann::json{{"front buffer", 2}, {"no reply from the nodes", 1}}));
    const auto packets = head.node(1).packets();
    const std::vector<uint32_t> gone{static_cast<uint32_t>(wire::HeadCommand::ClientGone), id};
    EXPECT_EQ(packets[packets.size() - 2].words, gone);
}

TEST(HeadSession, keepsAProgramThatClosesItsSocketUntilItsMemoryIsUnmapped) {
    SessionHarness head(1);
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    program.closeSocket();
    ASSERT_TRUE(swapFrames(program, 1, 3));
    ASSERT_TRUE(program.waitFramesDone(3));
    poll(nullptr, 0, 200); // several checks of the head
    ASSERT_TRUE(swapFrames(program, 4, 6));
    ASSERT_TRUE(program.waitFramesDone(6));
    EXPECT_EQ(program.header()->headLiveness & FUTEX_OWNER_DIED, 0U);
    EXPECT_NE(program.header()->headLiveness, 0U);
    program.disconnect();
    while (head.waitFor("clients")["count"] != 0) {}
    EXPECT_EQ(head.finish()["frames"], 6);
}

TEST(HeadSession, readsPublicationsMadeJustBeforeAProgramsEnd) {
    SessionHarness head(1);
    head.start();
    head.waitFor("ready");
    constexpr int kPrograms = 200;
    for (int i = 0; i < kPrograms; ++i) {
        FakeProgram program;
        ASSERT_TRUE(program.connect(head.config.session));
        ASSERT_EQ(program.welcome().refused, 0u) << program.text();
        ASSERT_TRUE(swapFrames(program, 1, 2)); // the first one wakes the head, the second one races with it
        program.disconnect();
    }
    EXPECT_EQ(head.finish()["nodes"][0]["frames"], 2 * kPrograms);
}

TEST(HeadSession, continuesWhenANodeIsLostInMidFrame) {
    for (const bool garbage : {false, true}) {
        SessionHarness head(3);
        (garbage ? head.behaviours[1].garbageAtFrame : head.behaviours[1].dieAtFrame) = 5;
        head.start();
        head.waitFor("ready");
        FakeProgram program;
        ASSERT_TRUE(program.connect(head.config.session));
        ASSERT_TRUE(swapFrames(program, 1, 20));
        EXPECT_TRUE(program.waitFramesDone(20));
        const std::string line = head.waitForMessage("was lost");
        EXPECT_EQ(line.rfind("node 1 (local) was lost: ", 0), 0u) << line;
        EXPECT_NE(line.find("its tiles keep their last picture"), std::string::npos);
        const auto report = head.finish();
        EXPECT_EQ(report["nodes"][1]["lost"], true);
        EXPECT_EQ(report["nodes"][0]["lost"], false);
        EXPECT_EQ(report["frames"], 20);
    }
}

TEST(HeadSession, answersWhenANodeIsLostInMidRequest) {
    for (const bool half : {false, true}) {
        SessionHarness head(3);
        head.behaviours[2].dieAtRequest = 7;
        head.behaviours[2].halfAnswer = half;
        head.start();
        head.waitFor("ready");
        FakeProgram program;
        ASSERT_TRUE(program.connect(head.config.session));
        ASSERT_TRUE(program.publish(kFakePixels, {7, 0, 0, 64, 48}));
        FakeProgram::Answer answer;
        ASSERT_TRUE(program.readAnswer(answer));
        EXPECT_EQ(answer.header.failed, 0u);
        EXPECT_EQ(answer.header.w, half ? 64 : 42); // two of three columns
        const auto* words = reinterpret_cast<const uint32_t*>(answer.bytes.data());
        EXPECT_EQ(words[0], 1u);
        if (half) {
            EXPECT_EQ(words[63], 64u);     // the row that the node had sent
            EXPECT_EQ(words[64 + 63], 0u); // and one that it had not sent
            EXPECT_EQ(words[64 + 41], 1042u);
        }
        head.finish();
    }
}

constexpr int64_t kLongPauseMs = 1200;

// Several times the size of the reply ring: the head stores the replies and continues. The program reads none of them
// for a while.
TEST(HeadSession, keepsDeferredRepliesForTheProgram) {
    SessionHarness head(2);
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    constexpr uint32_t kDeferredReplies = 12, kWords = 300'000;
    for (uint32_t i = 1; i <= kDeferredReplies; ++i)
        ASSERT_TRUE(program.publish(kFakeBytes, {capture::kDeferred | i, kWords + i}));
    ASSERT_TRUE(program.publish(kFakeSum, {77}));
    ASSERT_TRUE(swapFrames(program, 1, 20));
    ASSERT_TRUE(program.waitFramesDone(20)); // the ring is full by then
    std::this_thread::sleep_for(std::chrono::milliseconds(kLongPauseMs));
    EXPECT_EQ(program.header()->headGone.load(), 0u);
    for (uint32_t i = 1; i <= kDeferredReplies; ++i) {
        FakeProgram::Answer answer;
        ASSERT_TRUE(program.readAnswer(answer));
        EXPECT_EQ(answer.header.requestId, capture::kDeferred | i);
        EXPECT_EQ(answer.header.failed, 0u);
        EXPECT_EQ(answer.bytes.size(), (kWords + i) * 4u);
    }
    FakeProgram::Answer awaited;
    ASSERT_TRUE(program.readAnswer(awaited));
    EXPECT_EQ(awaited.header.requestId, 77u);
    head.finish();
    EXPECT_EQ(head.status(), 0);
}

// The program behaves like one that is stopped in the middle of a read.
TEST(HeadSession, keepsTheRestOfAReplyForAProgramThatReadsNothing) {
    SessionHarness head(2);
    head.start();
    head.waitFor("ready");
    FakeProgram program, other;
    ASSERT_TRUE(program.connect(head.config.session));
    ASSERT_TRUE(other.connect(head.config.session));
    constexpr uint32_t kWords = capture::kReplyBytes / 4 + 100'000;
    ASSERT_TRUE(program.publish(kFakeBytes, {1, kWords}));
    std::this_thread::sleep_for(std::chrono::milliseconds(kLongPauseMs));
    ASSERT_TRUE(swapFrames(other, 1, 20)); // the other program continues
    ASSERT_TRUE(other.waitFramesDone(20));
    EXPECT_EQ(program.header()->headGone.load(), 0u);
    EXPECT_GT(program.header()->headBeat.load(), 3u);
    FakeProgram::Answer answer;
    ASSERT_TRUE(program.readAnswer(answer));
    EXPECT_EQ(answer.header.failed, 0u);
    EXPECT_EQ(answer.bytes.size(), kWords * 4u);
    head.finish();
    EXPECT_EQ(head.status(), 0);
}

TEST(HeadSession, letsProgramsContinueWithoutNodes) {
    SessionHarness head(2);
    head.behaviours[0].dieAtFrame = 3;
    head.behaviours[1].dieAtFrame = 3;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    ASSERT_TRUE(swapFrames(program, 1, 3));
    EXPECT_TRUE(program.waitHeadGone());
    head.waitForMessage("all render nodes are lost");
    FakeProgram late;
    ASSERT_TRUE(late.connect(head.config.session));
    EXPECT_EQ(late.welcome().refused, 1u);
    EXPECT_EQ(head.finish()["frames"], 2);
}

TEST(HeadSession, reportsANodeThatIsNeverReady) {
    SessionHarness head(2);
    head.behaviours[1].silentStart = true;
    head.options.readyPatienceMs = 100;
    head.start();
    const auto error = head.waitFor("error");
    EXPECT_NE(error["text"].get<std::string>().find("node 1 (local) was not ready"), std::string::npos) << error;
}

TEST(HeadSession, endsWithoutANodesFarewell) {
    SessionHarness head(2);
    head.behaviours[1].noBye = true;
    head.start();
    head.waitFor("ready");
    const auto report = head.finish();
    EXPECT_EQ(report["nodes"][1]["lost"], true);
    EXPECT_EQ(report["nodes"][0]["lost"], false);
}

TEST(HeadSession, endsWhenANodeReadsNothing) {
    std::atomic<bool> isPaused{false};
    SessionHarness head(2);
    head.pipeBytes = 4096;
    head.behaviours[1].isPaused = &isPaused;
    head.options.drainPatienceMs = 100;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    isPaused = true;
    std::vector<uint32_t> words(4000, 0);
    words[0] = 4000;
    words[1] = kFakeNote;
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(program.publishWords(words));
    const auto report = head.finish();
    EXPECT_EQ(report["nodes"][1]["lost"], true);
    isPaused = false;
}

TEST(HeadSession, endsWhenTheControlConnectionBreaks) {
    for (int round = 0; round < 20; ++round) { // to cover the moment of the program's admission
        SessionHarness head(2);
        head.start();
        head.waitFor("ready");
        FakeProgram program;
        ASSERT_TRUE(program.connect(head.config.session));
        ASSERT_TRUE(swapFrames(program, 1, 4));
        head.breakControl();
        EXPECT_EQ(head.status(), 0);
        EXPECT_TRUE(program.waitHeadGone());
        EXPECT_EQ(program.header()->framesDone.load(), 4u); // drained nevertheless
    }
}

TEST(HeadSession, reportsWhenTheRequestedFramesAreOnTheWall) {
    SessionHarness head(2);
    head.config.frames = 5;
    head.start();
    head.waitFor("ready");
    FakeProgram program;
    ASSERT_TRUE(program.connect(head.config.session));
    ASSERT_TRUE(swapFrames(program, 1, 5));
    head.waitFor("frames-reached");
    const auto report = head.finish();
    EXPECT_EQ(report["frames"], 5);
    EXPECT_GT(report["bytesPerFrame"].get<int>(), 20);
}

} // namespace
} // namespace mural
