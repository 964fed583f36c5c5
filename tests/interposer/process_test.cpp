// A forked child is recognised with every way of forking, and is not blocked by a lock of its parent.
#include <gtest/gtest.h>

#include <csignal>
#include <functional>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "interposer/context/lock.hpp"
#include "interposer/process/process.hpp"
#include "interposer/memory/readable.hpp"

namespace mural {

namespace {

int childBegins = 0;

// Returns whether `check` is true in a child in which no pthread_atfork handler runs.
bool trueInChild(const std::function<bool()>& check) {
    const auto pid = static_cast<pid_t>(syscall(SYS_fork));
    if (pid == 0) {
        alarm(10);
        _exit(check() ? 0 : 1);
    }
    int status = 0;
    return pid > 0 && waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

} // namespace

TEST(Process, beginsTheChildOnceAfterARawFork) {
    const uint32_t mine = process::number();
    process::onChildBegins([] { ++childBegins; });
    EXPECT_TRUE(trueInChild(
        [=] { return process::number() == mine + 1 && process::number() == mine + 1 && childBegins == 1; }));
    EXPECT_EQ(process::number(), mine);
    EXPECT_EQ(childBegins, 0);
}

TEST(Process, clearsMemoryInTheChildOnly) {
    (void)process::number();
    auto* const word = static_cast<uint32_t*>(process::memory(sizeof(uint32_t)));
    ASSERT_NE(word, nullptr);
    EXPECT_EQ(*word, 0U);
    *word = 7;
    EXPECT_TRUE(trueInChild([=] { return *word == 0; }));
    EXPECT_EQ(*word, 7U);
}

TEST(Process, dropsTheSessionInTheChild) {
    (void)process::number();
    process::page.session = reinterpret_cast<Session*>(&childBegins);
    process::page.connectTried = true;
    EXPECT_TRUE(trueInChild([] { return process::page.session == nullptr && !process::page.connectTried; }));
    process::page.session = nullptr;
    process::page.connectTried = false;
}

TEST(Lock, isFreeInTheChildWhenHeldByTheParent) {
    Lock retained, tried;
    retained.lock();
    tried.lock();
    EXPECT_TRUE(trueInChild([&] {
        retained.lock(); // would wait for a thread that does not exist in the child
        return tried.tryLock() && !tried.tryLock() && !retained.tryLock();
    }));
    EXPECT_FALSE(retained.tryLock());
    retained.unlock();
    EXPECT_TRUE(retained.tryLock());
}

TEST(Readable, endsAtTheFirstPageWithoutRights) {
    const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
    auto* const pages =
        static_cast<char*>(mmap(nullptr, 4 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    ASSERT_NE(pages, MAP_FAILED);
    ASSERT_EQ(mprotect(pages + 2 * page, page, PROT_NONE), 0);
    EXPECT_EQ(readableBytes(pages + 12, 100), 100U);
    EXPECT_EQ(readableBytes(pages + 12, 4 * page - 12), 2 * page - 12);
    EXPECT_EQ(readableBytes(pages + 2 * page - 3, 3), 3U);
    EXPECT_EQ(readableBytes(pages + 2 * page + 5, 8), 0U);
    EXPECT_EQ(readableBytes(nullptr, 8), 0U);
    munmap(pages, 4 * page);
}

} // namespace mural
