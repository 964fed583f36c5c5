#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "objects/core/object_keeper.hpp"
#include "objects/ends/object_writer.hpp"
#include "objects/ends/reader_core.hpp"
#include "tests/objects/recording_sink.hpp"
#include "tests/objects/test_types.hpp"

namespace mural::objects::test {
namespace {

using mural::test::Light;
using mural::test::Material;
using mural::test::Tree;

struct Scene {
    double angle = 0;
    std::vector<float> heights;
    Ref<Tree> tree;
    Blob mesh;
    template <class Visit> void fields(Visit& visit) { visit(angle, heights, tree, mesh); }
};

// Scene with another second field.
struct ForeignScene {
    double angle = 0;
    std::vector<double> heights;
    Ref<Tree> tree;
    Blob mesh;
    template <class Visit> void fields(Visit& visit) { visit(angle, heights, tree, mesh); }
};

// Two types of one layout.
struct Camera {
    double value = 0;
    template <class Visit> void fields(Visit& visit) { visit(value); }
};
struct Clock {
    double value = 0;
    template <class Visit> void fields(Visit& visit) { visit(value); }
};

constexpr PeerId kReader = 1;

// Moves the value out. Requires success.
template <class T> T taken(Result<T> result) { return std::move(result.value()); }

// A writer and a reader that exchange messages at once.
class Pair {
public:
    explicit Pair(const MasterOptions& options = {.gatherNs = 0})
        : toReader_(*this), toWriter_(*this), writer(toReader_, options), end(toWriter_) {}

    // Delivers all messages; the reply to a message follows it.
    void exchange() {
        for (bool moved = true; moved;) {
            moved = false;
            for (const auto& message : toReader_.take()) {
                moved = true;
                const auto result = end.input(message, nowNs);
                if (!result) errors.push_back(result.error().message);
                bytes += message.size();
            }
            for (const auto& message : toWriter_.take()) {
                moved = true;
                const auto result = writer.input(kReader, message, nowNs);
                if (!result) errors.push_back(result.error().message);
            }
        }
    }
    [[nodiscard]] ObjectReader& reader() { return end.reader(); }

private:
    class Line : public MessageSink {
    public:
        explicit Line(Pair&) {}
        void toAll(std::span<const std::byte> message) override { toOne(0, message); }
        void toOne(PeerId, std::span<const std::byte> message) override {
            const std::lock_guard lock(mutex_);
            messages_.emplace_back(message.begin(), message.end());
        }
        std::vector<std::vector<std::byte>> take() {
            const std::lock_guard lock(mutex_);
            return std::exchange(messages_, {});
        }

    private:
        std::mutex mutex_;
        std::vector<std::vector<std::byte>> messages_;
    };
    Line toReader_, toWriter_;

public:
    ObjectWriter writer;
    ReaderEnd end;
    int64_t nowNs = 0;
    uint64_t bytes = 0;
    std::vector<std::string> errors;
};

const Deadline kAtOnce = Deadline::inMs(0);

TEST(TypedEnds, distinguishTypesOfOneLayoutAndName) {
    Pair pair;
    auto camera = taken(pair.writer.share(Camera{1}));
    auto clock = taken(pair.writer.share(Clock{2}));
    ASSERT_TRUE(camera.commit().ok() && clock.commit().ok());
    pair.exchange();
    pair.end.frame(1);
    EXPECT_EQ(pair.reader().stateAt<Camera>(1, "", kAtOnce).value()->value, 1);
    EXPECT_EQ(pair.reader().stateAt<Clock>(1, "", kAtOnce).value()->value, 2);
}

// Objects and states without a name do not meet, and the type decides between equal layouts.
TEST(TypedEnds, findStatesByTypeAndName) {
    Pair pair;
    auto camera = taken(pair.writer.share(Camera{1}));
    auto state = taken(pair.writer.share(Camera{2}, {.name = native::stateName("")}));
    ASSERT_TRUE(camera.commit().ok() && state.commit().ok());
    pair.exchange();
    pair.end.frame(1);
    EXPECT_EQ(pair.reader().stateAt<Camera>(1, native::stateName(""), kAtOnce).value()->value, 2);
    const auto clock = pair.reader().stateAt<Clock>(1, native::stateName(""), kAtOnce);
    ASSERT_FALSE(clock) << "of the same layout";
    EXPECT_EQ(clock.error().message, "the application has no state of type " + archive::layoutOf<Clock>().typeName +
                                         "; with this name it has " + archive::layoutOf<Camera>().typeName);
    const auto named = pair.reader().stateAt<Camera>(1, native::stateName("left"), kAtOnce);
    ASSERT_FALSE(named);
    EXPECT_EQ(named.error().message, "the application has no state of type " + archive::layoutOf<Camera>().typeName +
                                         " with the name \"left\"");
}

TEST(TypedEnds, receiveInTheWaitingThread) {
    Pair pair;
    auto scene = taken(pair.writer.share(Scene{.angle = 4}, {.name = "scene"}));
    ASSERT_TRUE(scene.commit().ok());
    int calls = 0;
    pair.end.waitBy([&](Deadline) {
        if (++calls == 3) pair.exchange(); // the first calls receive nothing
        return calls < 5;
    });
    EXPECT_EQ(pair.reader().get(scene.ref()).value()->angle, 4);
    EXPECT_EQ(calls, 3);
    EXPECT_FALSE(pair.reader().get(Ref<Scene>{{Uuid{std::byte{1}}, 1}}).ok()); // no more messages
    EXPECT_EQ(calls, 5);
}

TEST(TypedEnds, showReadersCommittedStateOnly) {
    Pair pair;
    auto scene = taken(pair.writer.share(Scene{}, {.name = "scene"}));
    scene.edit().angle = 1;
    pair.exchange();
    EXPECT_FALSE(pair.reader().get(Ref<Scene>{scene.ref()}, kAtOnce));
    EXPECT_EQ(scene.commit().value(), 1U);
    scene.edit().angle = 2;
    pair.exchange();
    const Snapshot<Scene> first = pair.reader().get(scene.ref()).value();
    EXPECT_EQ(first->angle, 1);
    EXPECT_EQ(scene.commit().value(), 2U);
    pair.exchange();
    EXPECT_EQ(pair.reader().get(scene.ref()).value()->angle, 2);
    EXPECT_EQ(first->angle, 1);
    EXPECT_EQ(pair.errors, std::vector<std::string>());
}

TEST(TypedEnds, commitSendsChangedFieldsOnly) {
    Pair pair;
    auto scene = taken(pair.writer.share(Scene{.heights = std::vector<float>(10'000)}));
    ASSERT_TRUE(scene.commit());
    pair.exchange();
    pair.bytes = 0;
    EXPECT_EQ(scene.commit().value(), 1U);
    pair.exchange();
    EXPECT_EQ(pair.bytes, 0U);
    scene.edit().angle = 4;
    EXPECT_EQ(scene.commit().value(), 2U);
    pair.exchange();
    EXPECT_LE(pair.bytes, 40U);
    scene.touch();
    EXPECT_EQ(scene.commit().value(), 3U);
    pair.exchange();
    EXPECT_GT(pair.bytes, 40'000U);
    EXPECT_EQ(pair.reader().get(scene.ref()).value()->angle, 4);
}

TEST(TypedEnds, shareOneSnapshotPerVersion) {
    Pair pair;
    auto scene = taken(pair.writer.share(Scene{}));
    ASSERT_TRUE(scene.commit());
    pair.exchange();
    EXPECT_EQ(pair.reader().get(scene.ref()).value(), pair.reader().get(scene.ref()).value());
    EXPECT_EQ(pair.reader().peek(scene.ref()), pair.reader().get(scene.ref()).value());
}

TEST(TypedEnds, showEachFrameItsVersion) {
    Pair pair;
    auto scene = taken(pair.writer.share(Scene{}, {.name = "scene"}));
    const auto frame = [&](uint64_t number) {
        pair.exchange();
        pair.writer.frame(number);
        pair.end.frame(number);
    };
    for (uint64_t number = 1; number <= 4; ++number) {
        if (number != 3) {
            scene.edit().angle = static_cast<double>(number);
            ASSERT_TRUE(scene.commit());
        }
        frame(number);
    }
    const auto angleAt = [&](uint64_t number) {
        const auto state = pair.reader().stateAt<Scene>(number, "scene", kAtOnce);
        return state ? state.value()->angle : -1;
    };
    EXPECT_EQ(angleAt(1), 1);
    EXPECT_EQ(angleAt(2), 2);
    EXPECT_EQ(angleAt(3), 2);
    EXPECT_EQ(angleAt(4), 4);
    pair.end.frameDone(2);
    EXPECT_EQ(angleAt(1), -1);
    EXPECT_EQ(angleAt(3), 2);
    EXPECT_EQ(pair.reader().stateAt(4, scene.ref(), kAtOnce).value()->angle, 4);
}

TEST(TypedEnds, deliverObjectsOnDemand) {
    Pair pair;
    auto tree = taken(pair.writer.share(Tree{5, {}}, {.delivery = Delivery::OnDemand}));
    ASSERT_TRUE(tree.commit());
    pair.exchange();
    EXPECT_EQ(pair.reader().peek(tree.ref()), nullptr);
    pair.exchange();
    ASSERT_NE(pair.reader().peek(tree.ref()), nullptr);
    EXPECT_EQ(pair.reader().peek(tree.ref())->value, 5);
    tree.edit().value = 6;
    ASSERT_TRUE(tree.commit());
    pair.exchange();
    EXPECT_EQ(pair.reader().get(tree.ref(), kAtOnce).value()->value, 6);
}

TEST(TypedEnds, waitForObjectsAcrossThreads) {
    Pair pair;
    auto tree = taken(pair.writer.share(Tree{5, {}}, {.delivery = Delivery::OnDemand}));
    ASSERT_TRUE(tree.commit());
    pair.exchange();
    std::atomic<bool> isDone = false;
    std::thread line([&] {
        while (!isDone) {
            pair.exchange();
            std::this_thread::yield();
        }
    });
    const auto state = pair.reader().get(tree.ref());
    isDone = true;
    line.join();
    ASSERT_TRUE(state) << state.error().message;
    EXPECT_EQ(state.value()->value, 5);
}

TEST(TypedEnds, carryBlobsByBytesAndByPlace) {
    for (const BlobTransfer transfer : {BlobTransfer::Bytes, BlobTransfer::Place}) {
        Pair pair({.blobs = transfer, .gatherNs = 0});
        std::vector<std::byte> bytes(1'000'000, std::byte{7});
        bytes[999'999] = std::byte{9};
        auto scene = taken(pair.writer.share(Scene{.mesh = Blob::copyOf(bytes).value()}));
        ASSERT_TRUE(scene.commit());
        pair.exchange();
        EXPECT_EQ(pair.bytes > 1'000'000, transfer == BlobTransfer::Bytes);
        const auto state = pair.reader().get(scene.ref(), kAtOnce);
        ASSERT_TRUE(state) << state.error().message;
        EXPECT_TRUE(std::ranges::equal(state.value()->mesh.bytes(), bytes));
        scene.edit().angle = 1;
        pair.bytes = 0;
        ASSERT_TRUE(scene.commit());
        pair.exchange();
        EXPECT_LE(pair.bytes, 40U);
        EXPECT_TRUE(std::ranges::equal(pair.reader().get(scene.ref(), kAtOnce).value()->mesh.bytes(), bytes));
    }
}

TEST(TypedEnds, requestBlobsOfObjectsOnDemand) {
    Pair pair;
    const std::vector<std::byte> bytes(5'000'000, std::byte{7});
    auto scene = taken(pair.writer.share(Scene{.mesh = Blob::copyOf(bytes).value()}, {.delivery = Delivery::OnDemand}));
    ASSERT_TRUE(scene.commit());
    const AnyRef ref = scene.ref();
    pair.exchange();
    pair.reader().prefetch(std::span(&ref, 1));
    pair.exchange();
    EXPECT_TRUE(std::ranges::equal(pair.reader().get(scene.ref(), kAtOnce).value()->mesh.bytes(), bytes));
}

TEST(TypedEnds, refuseAnotherLayoutByField) {
    Pair pair;
    auto scene = taken(pair.writer.share(Scene{}, {.name = "scene"}));
    ASSERT_TRUE(scene.commit());
    pair.exchange();
    const auto state = pair.reader().get(Ref<ForeignScene>{scene.ref()}, kAtOnce);
    ASSERT_FALSE(state);
    EXPECT_NE(state.error().message.find("\"scene\""), std::string::npos);
    EXPECT_NE(state.error().message.find("field 2 is list of float64 here and list of float32 there"),
              std::string::npos)
        << state.error().message;
    EXPECT_FALSE(pair.reader().stateAt<ForeignScene>(1, "scene", kAtOnce));
}

TEST(TypedEnds, keepTheLastSnapshotAfterDamage) {
    RecordingSink sink;
    ObjectMaster master(sink);
    const auto& layout = archive::layoutOf<Material>();
    const ObjectNumber number = master.share({Uuid{std::byte{1}}, {.name = "steel"}, layout}).value();
    archive::EncodedSlots slots;
    archive::encodeSlots(Material{"good", {}}, slots);
    ASSERT_TRUE(master.commit(number, {3, {{slots.bytesOf(0), {}}, {slots.bytesOf(1), {}}}}));
    RecordingSink toWriter;
    ReaderEnd end(toWriter);
    const auto deliver = [&] {
        for (const auto& sent : sink.take()) EXPECT_TRUE(end.input(sent.bytes, 0));
    };
    deliver();
    const Ref<Material> newest{{Uuid{std::byte{1}}, 0}};
    EXPECT_EQ(end.reader().get(newest, kAtOnce).value()->name, "good");
    ASSERT_TRUE(master.commit(number, {1, {{slots.bytesOf(1), {}}}})); // not a text
    deliver();
    const auto damaged = end.reader().get(newest, kAtOnce);
    ASSERT_FALSE(damaged);
    EXPECT_EQ(damaged.error().message, "cannot read object \"steel\" (" + layout.typeName +
                                           ") version 2: field 1 ends too early; the last good version stays in use");
    archive::encodeSlots(Material{"again", {}}, slots);
    ASSERT_TRUE(master.commit(number, {1, {{slots.bytesOf(0), {}}}}));
    deliver();
    EXPECT_EQ(end.reader().get(newest, kAtOnce).value()->name, "again");
}

TEST(TypedEnds, waitForReadersThatAreBehind) {
    Pair pair;
    pair.writer.join(kReader, "left wall");
    auto light = taken(pair.writer.share(Light{}, {.mostUnread = 2, .name = "sun"}));
    for (int i = 0; i < 2; ++i) {
        light.edit().power += 1;
        ASSERT_TRUE(light.commit(kAtOnce));
    }
    light.edit().power += 1;
    const auto late = light.commit(kAtOnce);
    ASSERT_FALSE(late);
    EXPECT_NE(late.error().message.find("left wall"), std::string::npos) << late.error().message;
    pair.exchange();
    EXPECT_EQ(light.commit(kAtOnce).value(), 3U);
    light.edit().power += 1;
    ASSERT_TRUE(light.commit(kAtOnce));
    light.edit().power += 1;
    ASSERT_FALSE(light.commit(kAtOnce));
    pair.writer.leave(kReader);
    EXPECT_TRUE(light.commit(kAtOnce));
}

TEST(TypedEnds, endObjectsWithTheirWriter) {
    Pair pair;
    AnyRef ref;
    Snapshot<Scene> kept;
    {
        auto scene = taken(pair.writer.share(Scene{.angle = 3}, {.name = "scene"}));
        ASSERT_TRUE(scene.commit());
        ref = scene.ref();
        pair.exchange();
        kept = pair.reader().get(scene.ref()).value();
    }
    pair.writer.join(kReader, "reader"); // the catalogue tells that nothing else exists
    pair.exchange();
    const auto gone = pair.reader().get(Ref<Scene>{ref});
    ASSERT_FALSE(gone);
    EXPECT_NE(gone.error().message.find("has ended"), std::string::npos) << gone.error().message;
    EXPECT_EQ(kept->angle, 3);
    auto other = taken(pair.writer.share(Scene{}, {.name = "other"}));
    pair.writer.close();
    EXPECT_FALSE(other.commit());
    EXPECT_FALSE(pair.writer.share(Scene{}));
}

TEST(TypedEnds, serveNewcomersFromTheKeeper) {
    RecordingSink stream, toWriter;
    ObjectWriter writer(stream, {.blobs = BlobTransfer::Place, .keepsPushed = false});
    ObjectKeeper keeper(toWriter);
    auto scene = taken(writer.share(Scene{.heights = {1, 2}}, {.name = "scene"}));
    const std::vector<std::byte> bytes(100'000, std::byte{7});
    for (int i = 1; i <= 3; ++i) {
        scene.edit().angle = i;
        if (i == 2) scene.edit().mesh = Blob::copyOf(bytes).value();
        ASSERT_TRUE(scene.commit());
    }
    for (const auto& sent : stream.take()) ASSERT_TRUE(keeper.input(sent.bytes, 0));
    EXPECT_TRUE(toWriter.sent.empty());
    for (const BlobTransfer transfer : {BlobTransfer::Bytes, BlobTransfer::Place}) {
        ReaderEnd end(toWriter);
        keeper.writeCatalogue(transfer,
                              [&](std::span<const std::byte> message) { ASSERT_TRUE(end.input(message, 0)); });
        const auto state = end.reader().get(scene.ref(), kAtOnce);
        ASSERT_TRUE(state) << state.error().message;
        EXPECT_EQ(state.value()->angle, 3);
        EXPECT_EQ(state.value()->heights, (std::vector<float>{1, 2}));
        EXPECT_TRUE(std::ranges::equal(state.value()->mesh.bytes(), bytes));
    }
}

} // namespace
} // namespace mural::objects::test
