// Single rules of the state machines. simulation_test.cpp has random schedules.
#include <gtest/gtest.h>

#include "objects/core/object_keeper.hpp"
#include "objects/core/object_master.hpp"
#include "objects/core/object_mirror.hpp"
#include "tests/objects/recording_sink.hpp"

namespace mural::objects::test {
namespace {

constexpr Uuid kId{std::byte{1}};

StatePointer stateOf(Version version) {
    auto state = std::make_shared<ObjectState>();
    state->version = version;
    state->slots.push_back(std::make_shared<Slot>());
    return state;
}

ObjectDescription described(const ShareOptions& options, uint32_t fields = 1) {
    ObjectDescription description{kId, options, {}};
    description.layout.fieldCount = fields;
    description.layout.typeName = "Type";
    return description;
}

std::vector<std::byte> value(unsigned number) { return {static_cast<std::byte>(number)}; }

// Commits one value to the first slot.
Version commit(ObjectMaster& master, ObjectNumber number, const std::vector<std::byte>& bytes,
               const std::vector<Blob>& blobs = {}) {
    const auto version = master.commit(number, {1, {{bytes, blobs}}});
    EXPECT_TRUE(version) << version.error().message;
    return version ? version.value() : 0;
}

TEST(VersionHistory, keepsVersionsOfFramesInProgress) {
    VersionHistory history;
    for (Version version = 1; version <= 5; ++version) history.add(version, version, stateOf(version));
    history.trim(2, 0);
    EXPECT_EQ(history.oldest(), 3U);
    EXPECT_EQ(history.versionAtFrame(3), 3U);
    EXPECT_EQ(history.versionAtFrame(9), 5U);
    history.trim(9, 0);
    EXPECT_EQ(history.size(), 1U);
}

TEST(VersionHistory, keepsOlderVersionsOnRequest) {
    VersionHistory history;
    for (Version version = 1; version <= 5; ++version) history.add(version, 1, stateOf(version));
    history.trim(0, 2);
    EXPECT_EQ(history.oldest(), 3U);
    EXPECT_NE(history.at(3), nullptr);
    EXPECT_EQ(history.at(2), nullptr);
    EXPECT_EQ(history.versionAtFrame(1), 5U);
}

TEST(VersionHistory, keepsTheNewestStateWhileALaterOneIsMissing) {
    VersionHistory history;
    history.add(1, 1, stateOf(1));
    history.add(2, 2, nullptr);
    history.trim(8, 0);
    ASSERT_NE(history.newestState(), nullptr);
    EXPECT_EQ(history.newestState()->version, 1U);
    EXPECT_EQ(history.newest(), 2U);
}

TEST(VersionHistory, usesVersionsThatPrecedeTheirAnnouncement) {
    VersionHistory history;
    history.add(2, VersionHistory::kNotAnnounced, stateOf(2));
    EXPECT_EQ(history.versionAtFrame(7), 0U);
    history.announce(1, 3);
    EXPECT_EQ(history.versionAtFrame(7), 1U);
    history.announce(2, 4);
    EXPECT_EQ(history.versionAtFrame(3), 1U);
    EXPECT_EQ(history.versionAtFrame(4), 2U);
}

TEST(ObjectKeeper, refusesCommitsThatDoNotFollow) {
    RecordingSink sink, toWriter;
    ObjectMaster master(sink);
    const ObjectNumber number = master.share(described({}, 2)).value();
    const auto bytes = value(1);
    ASSERT_TRUE(master.commit(number, {3, {{bytes, {}}, {bytes, {}}}}));
    for (unsigned i = 2; i <= 3; ++i) commit(master, number, value(i));
    const auto sent = sink.take(); // Share, three Commits
    ASSERT_EQ(sent.size(), 4U);
    ObjectKeeper keeper(toWriter);
    EXPECT_FALSE(keeper.input(sent[1].bytes, 0)) << "a commit without its Share";
    EXPECT_TRUE(keeper.input(sent[0].bytes, 0));
    EXPECT_TRUE(keeper.input(sent[1].bytes, 0));
    EXPECT_FALSE(keeper.input(sent[3].bytes, 0)) << "version 2 is missing";
    EXPECT_EQ(keeper.newest(kId)->version, 1U);
    EXPECT_TRUE(keeper.input(sent[2].bytes, 0));
    EXPECT_TRUE(keeper.input(sent[3].bytes, 0));
    EXPECT_TRUE(keeper.input(sent[1].bytes, 0)) << "repeated";
    EXPECT_EQ(keeper.newest(kId)->version, 3U);
    EXPECT_EQ(keeper.sizeBytes(), 2U);
}

TEST(ObjectMaster, refusesWrongCommits) {
    RecordingSink sink;
    ObjectMaster master(sink);
    const ObjectNumber fixed = master.share(described({.sharing = Sharing::Static, .name = "fixed"})).value();
    const auto bytes = value(1);
    EXPECT_FALSE(master.commit(fixed, {0, {}})) << "the first commit has all slots";
    EXPECT_FALSE(master.commit(fixed, {3, {{bytes, {}}, {bytes, {}}}})) << "a slot beyond the last";
    EXPECT_EQ(commit(master, fixed, value(1)), 1U);
    const auto again = master.commit(fixed, {1, {{bytes, {}}}});
    ASSERT_FALSE(again);
    EXPECT_NE(again.error().message.find("\"fixed\" (Type): it is static"), std::string::npos) << again.error().message;
    EXPECT_FALSE(master.commit(77, {1, {{bytes, {}}}}));
    EXPECT_FALSE(master.share(described({.name = std::string(256, 'x')})));
}

TEST(ObjectMaster, answersSeveralReadersAtOnce) {
    RecordingSink sink;
    ObjectMaster master(sink, {.gatherNs = 2'000'000});
    const ObjectNumber number = master.share(described({.delivery = Delivery::OnDemand})).value();
    commit(master, number, value(1));
    sink.take();
    const auto want = encode(WantMessage{number, 0, 0});
    ASSERT_TRUE(master.input(1, want.bytes(), 0));
    ASSERT_TRUE(master.input(2, want.bytes(), 1'000'000));
    master.tick(1'900'000);
    EXPECT_TRUE(sink.sent.empty());
    master.tick(2'000'000);
    ASSERT_EQ(sink.kinds(), std::vector{MessageKind::Commit});
    EXPECT_FALSE(sink.take().front().to.has_value()) << "one message to all";
    ASSERT_TRUE(master.input(3, want.bytes(), 3'000'000));
    master.tick(6'000'000);
    EXPECT_EQ(sink.take().front().to, 3U);
}

TEST(ObjectMaster, sendsDifferencesToReadersOfKeptVersions) {
    RecordingSink sink;
    ObjectMaster master(sink, {.gatherNs = 0});
    const ShareOptions options{.delivery = Delivery::OnDemand, .keptVersions = 5};
    const ObjectNumber number = master.share(described(options, 2)).value();
    const std::vector<std::byte> large(1000);
    ASSERT_TRUE(master.commit(number, {3, {{large, {}}, {large, {}}}}));
    commit(master, number, value(2));
    sink.take();
    ASSERT_TRUE(master.input(1, encode(WantMessage{number, 2, 1}).bytes(), 0));
    EXPECT_LT(sink.take().front().bytes.size(), 20U);
    ASSERT_TRUE(master.input(1, encode(WantMessage{number, 2, 0}).bytes(), 0));
    EXPECT_GT(sink.take().front().bytes.size(), 1000U);
}

TEST(ObjectMaster, refusesCommitsBeyondTheLimitOfItsLane) {
    RecordingSink sink;
    ObjectMaster master(sink, {.mostCommitBytes = 100});
    const ObjectNumber number = master.share(described({.name = "mesh"})).value();
    const std::vector<std::byte> most(100), more(101);
    commit(master, number, most);
    const auto refused = master.commit(number, {1, {{more, {}}}});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "cannot commit object \"mesh\" (Type): its changed fields have 101 bytes, of at "
                                       "most 100; use mural::Blob for large data");
    EXPECT_EQ(master.versionOf(number), 1U);
}

TEST(ObjectMaster, sendsABlobOnceWhileItIsInUse) {
    RecordingSink sink;
    ObjectMaster master(sink);
    const ObjectNumber number = master.share(described({})).value();
    const Blob blob = Blob::copyOf(value(9)).value();
    const auto begins = [&] {
        const auto kinds = sink.kinds();
        sink.take();
        return std::count(kinds.begin(), kinds.end(), MessageKind::BlobBegin);
    };
    commit(master, number, value(1), {blob});
    EXPECT_EQ(begins(), 1);
    commit(master, number, value(2), {blob});
    EXPECT_EQ(begins(), 0);
    commit(master, number, value(3));
    commit(master, number, value(4), {blob});
    EXPECT_EQ(begins(), 1) << "readers may have dropped it meanwhile";
}

TEST(ObjectMaster, keepsMemoryBoundedByFramesInProgress) {
    RecordingSink sink;
    ObjectMaster master(sink);
    const ObjectNumber number = master.share(described({})).value();
    const std::vector<std::byte> large(1000);
    for (uint64_t frame = 1; frame <= 100; ++frame) {
        for (int i = 0; i < 3; ++i) commit(master, number, large);
        master.frame(frame);
        if (frame > 2) master.frameDone(frame - 2);
        EXPECT_LE(master.keptBytes(), 4000U);
        sink.take();
    }
    master.unshare(number);
    EXPECT_EQ(master.keptBytes(), 0U);
    EXPECT_EQ(master.objectCount(), 0U);
}

TEST(ObjectMirror, repeatsRequestsWithoutAReply) {
    RecordingSink sink, toWriter;
    ObjectMaster master(sink, {.gatherNs = 0});
    const ObjectNumber number = master.share(described({.delivery = Delivery::OnDemand})).value();
    const Blob blob = Blob::copyOf(std::vector<std::byte>(100, std::byte{3})).value();
    commit(master, number, value(1), {blob});
    ObjectMirror mirror(toWriter);
    for (const auto& sent : sink.take()) ASSERT_TRUE(mirror.input(sent.bytes, 0));
    const auto answer = [&](MessageKind kind, int64_t nowNs) {
        mirror.tick(nowNs);
        EXPECT_EQ(toWriter.kinds(), std::vector{kind});
        for (const auto& sent : toWriter.take()) ASSERT_TRUE(master.input(1, sent.bytes, nowNs));
    };
    mirror.want({kId, 0}, 0);
    toWriter.take(); // lost
    mirror.tick(BlobIntake::kRetryNs / 2);
    EXPECT_TRUE(toWriter.sent.empty());
    answer(MessageKind::Want, BlobIntake::kRetryNs);
    for (const auto& sent : sink.take()) ASSERT_TRUE(mirror.input(sent.bytes, BlobIntake::kRetryNs));
    toWriter.take(); // the request for the blob is lost
    EXPECT_EQ(mirror.find({kId, 0}).presence, ObjectMirror::Presence::Waiting);
    answer(MessageKind::WantBlob, 3 * BlobIntake::kRetryNs);
    for (const auto& sent : sink.take()) ASSERT_TRUE(mirror.input(sent.bytes, 3 * BlobIntake::kRetryNs));
    ASSERT_EQ(mirror.find({kId, 0}).presence, ObjectMirror::Presence::Here);
    EXPECT_EQ(mirror.find({kId, 0}).state->slots[0]->blobs[0]->blob, blob);
}

// The writer is a process of this machine, here this one. `isMoved`: the place in its reply is invalid.
void requestBlobByPlace(bool isMoved) {
    RecordingSink sink, toWriter;
    ObjectMaster master(sink, {.gatherNs = 0});
    const ObjectNumber number = master.share(described({.delivery = Delivery::OnDemand})).value();
    const Blob blob = Blob::copyOf(std::vector<std::byte>(kMinSharedBlobBytes, std::byte{3})).value();
    commit(master, number, value(1), {blob});
    BlobIntakeOptions options;
    options.requestsPlaces = true;
    ObjectMirror mirror(toWriter, options);
    mirror.want({kId, 0}, 0);
    std::vector<MessageKind> replies;
    for (int step = 0; step < 5; ++step) {
        for (const auto& sent : sink.take()) {
            Message message = *decode(sent.bytes);
            replies.push_back(kindOf(sent.bytes));
            if (auto* const at = std::get_if<BlobAtMessage>(&message); at && isMoved) ++at->place.inode;
            ASSERT_TRUE(mirror.input(message, 0));
        }
        if (step == 0) mirror.want({kId, 0}, 0);
        for (const auto& sent : toWriter.take()) ASSERT_TRUE(master.input(1, sent.bytes, 0));
    }
    const auto found = mirror.find({kId, 0});
    ASSERT_EQ(found.presence, ObjectMirror::Presence::Here);
    EXPECT_EQ(found.state->slots[0]->blobs[0]->blob, blob);
    const bool hasBytes = std::ranges::find(replies, MessageKind::BlobData) != replies.end();
    EXPECT_NE(std::ranges::find(replies, MessageKind::BlobAt), replies.end());
    EXPECT_EQ(hasBytes, isMoved);
}

TEST(ObjectMirror, mapsRequestedBlobsOfItsMachine) { requestBlobByPlace(false); }
TEST(ObjectMirror, requestsTheBytesOfABlobThatItCannotMap) { requestBlobByPlace(true); }

TEST(ObjectMirror, requestsPushedObjectsAfterAGap) {
    RecordingSink sink, toWriter;
    ObjectMaster master(sink, {.gatherNs = 0});
    const ObjectNumber number = master.share(described({}, 2)).value();
    const auto bytes = value(1);
    ASSERT_TRUE(master.commit(number, {3, {{bytes, {}}, {bytes, {}}}}));
    commit(master, number, value(2));
    commit(master, number, value(3));
    const auto sent = sink.take();
    ObjectMirror mirror(toWriter);
    for (const size_t at : {0U, 1U, 3U}) ASSERT_TRUE(mirror.input(sent[at].bytes, 0)); // version 2 is lost
    EXPECT_EQ(mirror.gaps(), 1U);
    for (const auto& request : toWriter.take()) ASSERT_TRUE(master.input(1, request.bytes, 0));
    for (const auto& reply : sink.take()) ASSERT_TRUE(mirror.input(reply.bytes, 0));
    EXPECT_EQ(mirror.find({kId, 0}).state->slots[0]->bytes, value(3));
}

TEST(ObjectMirror, refusesForeignSlots) {
    RecordingSink toWriter;
    ObjectMirror mirror(toWriter);
    ShareMessage share;
    share.number = 4;
    share.id = kId;
    share.name = "camera";
    share.typeName = "Camera";
    ASSERT_TRUE(mirror.input(Message(share), 0));
    const auto bytes = value(1);
    const auto result = mirror.input(Message(CommitMessage{4, 1, 0, 3, {{bytes, {}}, {bytes, {}}}}), 0);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("object \"camera\" (Camera): version 1 has other fields"), std::string::npos)
        << result.error().message;
    share.id = Uuid{std::byte{2}};
    EXPECT_FALSE(mirror.input(Message(share), 0)) << "another object with this number";
    EXPECT_FALSE(mirror.input(Message(WantMessage{4, 1, 0}), 0)) << "a message for the writer";
}

TEST(ObjectMirror, endsObjectsFromTheFrameInPreparationOn) {
    RecordingSink sink, toWriter;
    ObjectMaster master(sink);
    const ObjectNumber number = master.share(described({.name = "mesh"})).value();
    commit(master, number, value(1));
    ObjectMirror mirror(toWriter);
    const auto deliver = [&] {
        for (const auto& sent : sink.take()) ASSERT_TRUE(mirror.input(sent.bytes, 0));
    };
    deliver();
    mirror.frame(1);
    master.unshare(number);
    deliver();
    mirror.frame(2);
    EXPECT_EQ(mirror.findAtFrame(kId, 1).presence, ObjectMirror::Presence::Here);
    EXPECT_EQ(mirror.findAtFrame(kId, 2).presence, ObjectMirror::Presence::Unknown);
    archive::TypeLayout layout;
    layout.typeName = "Type";
    EXPECT_NE(mirror.shareOf("mesh", layout, 1), nullptr);
    EXPECT_EQ(mirror.shareOf("mesh", layout, 2), nullptr);
    mirror.frameDone(1);
    EXPECT_EQ(mirror.objectCount(), 0U);
}

TEST(ObjectMirror, reportsVersionsThatTheWriterNoLongerHas) {
    RecordingSink sink, toWriter;
    ObjectMaster master(sink, {.gatherNs = 0});
    const ObjectNumber number = master.share(described({.delivery = Delivery::OnDemand, .name = "mesh"})).value();
    for (unsigned i = 1; i <= 3; ++i) commit(master, number, value(i));
    ObjectMirror mirror(toWriter);
    for (const auto& sent : sink.take()) ASSERT_TRUE(mirror.input(sent.bytes, 0));
    mirror.want({kId, 1}, 0);
    for (const auto& sent : toWriter.take()) ASSERT_TRUE(master.input(1, sent.bytes, 0));
    std::string problem;
    for (const auto& sent : sink.take())
        if (const auto result = mirror.input(sent.bytes, 0); !result) problem = result.error().message;
    EXPECT_NE(problem.find("object \"mesh\" (Type): the writer no longer has version 1"), std::string::npos) << problem;
    EXPECT_EQ(mirror.find({kId, 1}).presence, ObjectMirror::Presence::Refused);
}

} // namespace
} // namespace mural::objects::test
