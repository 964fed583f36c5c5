// Changes of memory are found with their bytes, for all kinds of writers. Both for memory that the kernel watches and
// for memory that is compared as a whole.
#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <random>
#include <sys/mman.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "common/memory/dirty_pages.hpp"

namespace mural {
namespace {

constexpr size_t kSmall = 4096, kLarge = 1 << 20;

// Memory, its watcher, and a copy that is updated with the reported changes.
class Watched {
public:
    explicit Watched(size_t size, size_t offset = 0) : size_(size), mappedBytes_(size + 8192) {
        void* at = mmap(nullptr, mappedBytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        mapped_ = static_cast<std::byte*>(at);
        memory = mapped_ + offset;
        std::memset(memory, 7, size);
        copy.assign(memory, memory + size);
        EXPECT_TRUE(changes.begin(memory, size));
    }
    ~Watched() {
        changes.end();
        munmap(mapped_, mappedBytes_);
    }
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;

    void check(bool exact = false) {
        reported.clear();
        changes.collect(
            exact,
            [](void* self, size_t from, const std::byte* bytes, size_t size) {
                auto& its = *static_cast<Watched*>(self);
                its.reported.push_back({from, size});
                std::memcpy(its.copy.data() + from, bytes, size);
            },
            this);
    }
    [[nodiscard]] bool same() const { return std::memcmp(copy.data(), memory, size_) == 0; }

    struct Run {
        size_t from, size;
        bool operator==(const Run&) const = default;
    };
    DirtyPages changes;
    std::byte* memory = nullptr;
    std::vector<std::byte> copy;
    std::vector<Run> reported;

private:
    size_t size_, mappedBytes_;
    std::byte* mapped_ = nullptr;
};

bool kernelWatches() {
    Watched memory(kLarge);
    return memory.changes.watched();
}

class DirtyPagesOfSize : public testing::TestWithParam<size_t> {};
INSTANTIATE_TEST_SUITE_P(Sizes, DirtyPagesOfSize, testing::Values(kSmall, kLarge));

TEST_P(DirtyPagesOfSize, reportsWritesOnce) {
    Watched memory(GetParam());
    memory.memory[100] = std::byte{1};
    memory.check();
    EXPECT_EQ(memory.reported, (std::vector<Watched::Run>{{64, 64}}));
    EXPECT_TRUE(memory.same());
    memory.check();
    EXPECT_TRUE(memory.reported.empty());
}

TEST_P(DirtyPagesOfSize, reportsRandomWritesInLongAndShortIntervals) {
    Watched memory(GetParam());
    std::mt19937 random(5);
    for (int step = 0; step < 3000; ++step) {
        if (random() % 3 == 0) {
            const size_t size = 1 + random() % 700, at = random() % (GetParam() - size);
            std::memset(memory.memory + at, static_cast<int>(random() % 256), size);
        }
        for (unsigned quiet = random() % 50 == 0 ? 40 : 1; quiet > 0; --quiet) memory.check(step % 2 == 0);
        ASSERT_TRUE(memory.same()) << step;
    }
}

TEST_P(DirtyPagesOfSize, reportsWritesOfSystemCalls) {
    Watched memory(GetParam());
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    ASSERT_EQ(write(ends[1], "from a pipe", 11), 11);
    ASSERT_EQ(read(ends[0], memory.memory + GetParam() - 11, 11), 11);
    close(ends[0]);
    close(ends[1]);
    memory.check();
    EXPECT_FALSE(memory.reported.empty());
    EXPECT_TRUE(memory.same());
}

TEST_P(DirtyPagesOfSize, reportsConcurrentWritesOfOtherThreads) {
    Watched memory(GetParam());
    std::thread writer([&] {
        std::mt19937 random(9);
        for (int i = 0; i < 200'000; ++i) memory.memory[random() % GetParam()] = std::byte(random() % 256);
    });
    for (int i = 0; i < 200; ++i) memory.check();
    writer.join();
    memory.check();
    EXPECT_TRUE(memory.same());
}

TEST_P(DirtyPagesOfSize, reportsWritesOfAForkedChildOnlyToTheChild) {
    Watched memory(GetParam());
    const pid_t child = fork();
    if (child == 0) {
        memory.memory[0] = std::byte{200};
        memory.check();
        _exit(memory.reported.size() == 1 && memory.same() ? 0 : 1);
    }
    int status = 1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    memory.check();
    EXPECT_TRUE(memory.reported.empty());
    memory.memory[GetParam() - 1] = std::byte{3};
    memory.check();
    EXPECT_TRUE(memory.same());
}

TEST_P(DirtyPagesOfSize, reportsExactlyTheChangedWords) {
    Watched memory(GetParam());
    memory.memory[4] = memory.memory[15] = memory.memory[40] = std::byte{1};
    memory.check(true);
    EXPECT_EQ(memory.reported, (std::vector<Watched::Run>{{4, 4}, {12, 4}, {40, 4}}));
}

TEST_P(DirtyPagesOfSize, ignoresAcceptedForeignWrites) {
    Watched memory(GetParam());
    std::vector<std::byte> changed(memory.memory, memory.memory + 256);
    changed[8] = std::byte{9};
    size_t at = 0;
    memory.changes.accept(
        0, changed.data(), changed.size(),
        [](void* self, size_t from, const std::byte*, size_t) { *static_cast<size_t*>(self) = from; }, &at);
    EXPECT_EQ(at, 8U);
    memory.memory[8] = std::byte{9};
    memory.check();
    EXPECT_TRUE(memory.reported.empty());
    memory.memory[8] = std::byte{7}; // the previous value
    memory.check();
    EXPECT_EQ(memory.reported.size(), 1U);
}

TEST(DirtyPages, supportsMemoryThatBeginsAndEndsWithinPages) {
    Watched memory(kLarge - 1000, 300);
    for (int i = 0; i < 40; ++i) memory.check();
    memory.memory[-1] = memory.memory[kLarge - 1000] = std::byte{1}; // foreign bytes in the same pages
    memory.check();
    EXPECT_TRUE(memory.reported.empty());
    memory.memory[0] = memory.memory[kLarge - 1001] = std::byte{1};
    memory.check();
    EXPECT_EQ(memory.reported.size(), 2U);
    EXPECT_TRUE(memory.same());
}

TEST(DirtyPages, comparesWhenTheKernelWatchIsLost) {
    if (!kernelWatches()) GTEST_SKIP() << "this kernel can't watch memory";
    Watched memory(kLarge);
    // Maps other memory at the same address, so the kernel drops its watch.
    auto* page = memory.memory + 8 * 4096;
    ASSERT_NE(mmap(page, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0), MAP_FAILED);
    memory.check();
    EXPECT_FALSE(memory.changes.watched());
    EXPECT_TRUE(memory.same());
    memory.memory[5] = std::byte{1};
    memory.check();
    EXPECT_TRUE(memory.same());
}

TEST(DirtyPages, supportsSharedMemoryOfAFile) {
    const int file = memfd_create("shared", MFD_CLOEXEC);
    ASSERT_EQ(ftruncate(file, kLarge), 0);
    auto* memory = static_cast<std::byte*>(mmap(nullptr, kLarge, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    ASSERT_NE(memory, MAP_FAILED);
    DirtyPages changes;
    ASSERT_TRUE(changes.begin(memory, kLarge));
    for (int round = 0; round < 3; ++round) {
        memory[kLarge / 2] = std::byte(round + 1);
        int reported = 0;
        for (int i = 0; i < 40; ++i)
            changes.collect(
                false, [](void* self, size_t, const std::byte*, size_t) { ++*static_cast<int*>(self); }, &reported);
        EXPECT_EQ(reported, 1);
    }
    changes.end();
    munmap(memory, kLarge);
    close(file);
}

} // namespace
} // namespace mural
