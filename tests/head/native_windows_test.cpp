// The programs' own windows, with X servers that do not answer for a while.
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "nodes/head/frames/native_windows.hpp"
#include "tests/recorded_log.hpp"

namespace mural {
namespace {

// Records the calls that the windows receive, from all threads.
struct World {
    std::mutex mutex;
    std::condition_variable changed;
    std::set<uint64_t> stopped;                        // windows whose server does not answer
    std::set<uint32_t> grabbed;                        // clients that put their pictures themselves
    std::vector<std::pair<uint64_t, int64_t>> shown;   // window, frame
    std::multiset<std::pair<uint32_t, uint32_t>> done; // client, frame
    std::set<uint32_t> blocked;

    template <class Condition> bool wait(Condition condition) {
        std::unique_lock lock(mutex);
        return changed.wait_for(lock, std::chrono::seconds(20), condition);
    }
    template <class Change> void change(Change change) {
        const std::lock_guard lock(mutex);
        change();
        changed.notify_all();
    }
};

class SlowSink final : public PictureSink {
public:
    SlowSink(World& world, uint64_t window) : world_(world), window_(window) {}
    Result<void> show(int64_t frame, const Picture&) override {
        std::unique_lock lock(world_.mutex);
        isBlocked_ = world_.changed.wait_for(lock, std::chrono::milliseconds(20),
                                             [&] { return !world_.stopped.contains(window_); }) == false;
        if (isBlocked_) return Error{"it does not answer"};
        world_.shown.emplace_back(window_, frame);
        world_.changed.notify_all();
        return {};
    }
    [[nodiscard]] bool isBlocked() const override { return isBlocked_; }
    Result<void> finish() override { return {}; }
    [[nodiscard]] std::string describe() const override { return "a test"; }

private:
    World& world_;
    uint64_t window_;
    bool isBlocked_ = false;
};

class NativeWindowsTest : public ::testing::Test {
protected:
    NativeWindowsConfig config() {
        NativeWindowsConfig config;
        config.openWindow = [this](const WindowPicture& picture) {
            return Result<std::unique_ptr<PictureSink>>(std::make_unique<SlowSink>(world_, picture.nativeWindow));
        };
        config.giveToProgram = [this](const WindowPicture& picture, const Picture&) {
            const std::lock_guard lock(world_.mutex);
            return world_.grabbed.contains(picture.client);
        };
        config.done = [this](uint32_t client, uint32_t frame) {
            world_.change([&] { world_.done.emplace(client, frame); });
        };
        config.blocked = [this](uint32_t client, bool isBlocked) {
            world_.change([&] {
                isBlocked ? static_cast<void>(world_.blocked.insert(client))
                          : static_cast<void>(world_.blocked.erase(client));
            });
        };
        return config;
    }

    void show(uint32_t client, uint32_t frame) {
        auto picture = std::make_shared<OwnedPicture>();
        picture->resize(2, 2);
        windows_.show({client, 1, frame, client * 100, picture, {}});
    }

    RecordedLog log_;
    World world_;
    NativeWindows windows_{config()};
};

TEST_F(NativeWindowsTest, delaysOnlyTheProgramOfTheStoppedServer) {
    world_.stopped = {100};
    show(1, 1);
    ASSERT_TRUE(world_.wait([&] { return world_.blocked.contains(1); }));
    for (uint32_t frame = 2; frame <= 9; ++frame) show(1, frame);
    for (uint32_t frame = 1; frame <= 9; ++frame) show(2, frame);
    ASSERT_TRUE(world_.wait([&] { return world_.done.contains({2, 9}) && world_.done.contains({1, 8}); }));
    EXPECT_FALSE(world_.done.contains({1, 9})); // the latest waits
    world_.change([&] { world_.stopped.clear(); });
    ASSERT_TRUE(world_.wait([&] { return world_.done.contains({1, 9}) && world_.blocked.empty(); }));
    EXPECT_EQ(world_.done.size(), 18u); // each once
    EXPECT_EQ(world_.shown.back(), (std::pair<uint64_t, int64_t>{100, 9}));
    EXPECT_EQ(log_.texts().size(), 1u) << log_.text();
}

TEST_F(NativeWindowsTest, paintsNothingOverTheProgramsOwnOutput) {
    world_.grabbed = {1};
    show(1, 1);
    show(2, 1);
    ASSERT_TRUE(world_.wait([&] { return world_.done.contains({2, 1}); }));
    windows_.finish();
    ASSERT_EQ(world_.shown.size(), 1u);
    EXPECT_EQ(world_.shown[0].first, 200u);
    EXPECT_FALSE(world_.done.contains({1, 1})); // reported by the component that passes it to the program
}

TEST_F(NativeWindowsTest, endsWithAServerThatDoesNotAnswer) {
    world_.stopped = {100};
    for (uint32_t frame = 1; frame <= 3; ++frame) show(1, frame);
    show(2, 1);
    ASSERT_TRUE(world_.wait([&] { return world_.blocked.contains(1); }));
    windows_.finish();
    EXPECT_TRUE(world_.done.contains({2, 1}));
}

TEST_F(NativeWindowsTest, showsTheLastPictureOfAnEndedProgram) {
    show(1, 1);
    windows_.clientGone(1);
    windows_.finish();
    EXPECT_EQ(world_.shown.size(), 1u);
}

} // namespace
} // namespace mural
