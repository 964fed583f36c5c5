// Wake-ups through the capture memory: the reader of publications and a program that waits for frames.
#include "nodes/head/capture/capture_memory.hpp"

#include <csignal>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "common/base/clock.hpp"
#include "common/ipc/futex.hpp"
#include "nodes/head/capture/arrival_rate.hpp"
#include "nodes/head/capture/liveness_mark.hpp"

namespace mural {
namespace {

using capture::Reader;

class CaptureMemoryTest : public ::testing::Test {
protected:
    void SetUp() override {
        auto made = CaptureMemory::create(16, 4096);
        ASSERT_TRUE(made) << made.error().message;
        memory_ = std::move(made.value());
        base_ =
            mmap(nullptr, sizeof(capture::CaptureHeader), PROT_READ | PROT_WRITE, MAP_SHARED, memory_->fdToPass(), 0);
        ASSERT_NE(base_, MAP_FAILED);
        program_ = static_cast<capture::CaptureHeader*>(base_);
    }
    void TearDown() override { munmap(base_, sizeof(capture::CaptureHeader)); }

    [[nodiscard]] Reader reader() const { return static_cast<Reader>(program_->reader.load()); }
    // Sleeps like Session::waitForCredit in a thread of the program, until `frames` are done.
    void sleepForFrames(uint32_t frames) {
        uint32_t done = 0;
        while (static_cast<int32_t>((done = program_->framesDone.load()) - frames) < 0) {
            program_->framesWanted = capture::kFramesWanted | frames;
            futexWait(program_->framesDone, done, 10 * kNsPerS);
            ++wakes_;
        }
    }
    // Waits until the other thread requests `value`, at most 10 s.
    [[nodiscard]] bool wantedIs(uint64_t value) const {
        const Deadline deadline = Deadline::inMs(10'000);
        while (program_->framesWanted.load() != value && !deadline.passed()) std::this_thread::yield();
        return program_->framesWanted.load() == value;
    }

    std::unique_ptr<CaptureMemory> memory_;
    void* base_ = nullptr;
    capture::CaptureHeader* program_ = nullptr;
    int wakes_ = 0;
};

TEST_F(CaptureMemoryTest, wakesAProgramThatAChangeOfTheLatencyPermitsToContinue) {
    memory_->setLatency(1);
    std::thread sleeper([this] { // a thread of the program after its third swap, before any frame is done
        uint32_t done = 0;
        while (3 - (done = program_->framesDone.load()) > program_->latency.load()) {
            program_->framesWanted = capture::kFramesWanted | (3 - program_->latency.load());
            futexWait(program_->framesDone, done, 10 * kNsPerS);
            ++wakes_;
        }
    });
    ASSERT_TRUE(wantedIs(capture::kFramesWanted | 2));
    const Deadline patience = Deadline::inMs(100); // the thread may not be asleep yet
    while (!patience.passed()) std::this_thread::yield();
    const int64_t beganNs = monotonicNowNs();
    memory_->setLatency(3);
    sleeper.join();
    EXPECT_LT(monotonicNowNs() - beganNs, 5 * kNsPerS);
    EXPECT_EQ(wakes_, 1);
}

TEST(CaptureMemory, reportsAProgramWhileItHasADescriptorOrTheMapping) {
    auto memory = CaptureMemory::create(16, 4096);
    ASSERT_TRUE(memory) << memory.error().message;
    FileDescriptor passed(dup((*memory)->fdToPass())); // as SCM_RIGHTS does
    (*memory)->passed();
    EXPECT_FALSE((*memory)->programGone());
    void* mapping = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, passed.get(), 0);
    ASSERT_NE(mapping, MAP_FAILED);
    passed = FileDescriptor();
    EXPECT_FALSE((*memory)->programGone());
    munmap(mapping, 4096);
    EXPECT_TRUE((*memory)->programGone());
}

// A word in memory that a process shares with its child.
class LivenessMarkTest : public ::testing::Test {
protected:
    void SetUp() override {
        void* const page = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        ASSERT_NE(page, MAP_FAILED);
        word_ = new (page) std::atomic<uint32_t>{0};
    }
    void TearDown() override { munmap(word_, 4096); }

    std::atomic<uint32_t>* word_ = nullptr;
};

TEST_F(LivenessMarkTest, isMarkedWhenItsProcessIsKilled) {
    const pid_t child = fork();
    if (child == 0) {
        std::thread([this] {
            const LivenessMark mark(*word_);
            pause();
        }).join();
        _exit(0);
    }
    const Deadline deadline = Deadline::inMs(10'000);
    while (word_->load() == 0 && !deadline.passed()) std::this_thread::yield();
    EXPECT_NE(word_->load(), 0U);
    EXPECT_EQ(word_->load() & FUTEX_OWNER_DIED, 0U);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_NE(word_->load() & FUTEX_OWNER_DIED, 0U);
}

TEST_F(LivenessMarkTest, isMarkedWhenItsProcessEndsNormally) {
    std::thread([this] {
        const LivenessMark mark(*word_);
        EXPECT_EQ(word_->load(), static_cast<uint32_t>(gettid()));
    }).join();
    EXPECT_EQ(word_->load(), FUTEX_OWNER_DIED);
}

TEST_F(CaptureMemoryTest, endsANapAfterItsTime) {
    memory_->waitPublished(Reader::Naps, capture::kNapNs); // without a wake-up
    EXPECT_EQ(reader(), Reader::Reads);
}

TEST_F(CaptureMemoryTest, readsEarlierPublicationsWithoutSleeping) {
    program_->publishedTail = 1; // without a wake-up
    const int64_t sinceNs = monotonicNowNs();
    memory_->waitPublished(Reader::Sleeps, 60 * kNsPerS);
    EXPECT_LT(monotonicNowNs() - sinceNs, 30 * kNsPerS);
}

TEST_F(CaptureMemoryTest, announcesThatItSleeps) {
    std::thread sleeper([&] { memory_->waitPublished(Reader::Sleeps, 10 * kNsPerS); });
    const Deadline deadline = Deadline::inMs(10'000);
    while (reader() != Reader::Sleeps && !deadline.passed()) std::this_thread::yield();
    EXPECT_EQ(reader(), Reader::Sleeps);
    program_->publishedTail = 1;
    futexWakeAll(program_->publishedTail);
    sleeper.join();
    EXPECT_EQ(reader(), Reader::Reads);
}

TEST_F(CaptureMemoryTest, wakesAProgramWhenItsFramesAreDoneAndNotBefore) {
    std::thread program([&] { sleepForFrames(5); });
    ASSERT_TRUE(wantedIs(capture::kFramesWanted | 5));
    for (uint32_t frame = 1; frame <= 5; ++frame) {
        // no wake-up, so the request is not repeated
        EXPECT_EQ(program_->framesWanted.load(), capture::kFramesWanted | 5) << frame;
        memory_->setFramesDone(frame);
    }
    program.join();
    EXPECT_LE(wakes_, 5); // a change of the word just before it sleeps wakes it early
    EXPECT_EQ(program_->framesWanted.load(), 0u);
}

TEST_F(CaptureMemoryTest, countsFramesAcrossTheWrapOfTheirNumbers) {
    program_->framesDone = UINT32_MAX - 1;
    std::thread program([&] { sleepForFrames(1); });
    ASSERT_TRUE(wantedIs(capture::kFramesWanted | 1));
    memory_->setFramesDone(UINT32_MAX);
    EXPECT_TRUE(wantedIs(capture::kFramesWanted | 1));
    memory_->setFramesDone(1);
    program.join();
}

TEST(ArrivalRate, sleepsOnlyAfterTwoQuickArrivals) {
    ArrivalRate pace;
    constexpr int64_t kQuickNs = ArrivalRate::kQuickNs;
    EXPECT_FALSE(pace.moreSoon(0));
    pace.arrived(0);
    EXPECT_FALSE(pace.moreSoon(1));
    pace.arrived(kQuickNs);
    EXPECT_FALSE(pace.moreSoon(kQuickNs + 1));
    pace.arrived(2 * kQuickNs - 1);
    EXPECT_TRUE(pace.moreSoon(2 * kQuickNs));
    EXPECT_FALSE(pace.moreSoon(3 * kQuickNs)); // without an arrival
}

} // namespace
} // namespace mural
