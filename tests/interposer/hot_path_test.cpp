// A small call makes no allocation and no system call while its chunk has room.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "encoders.hpp"
#include "tests/interposer/encoder_harness.hpp"

#if !defined(__SANITIZE_ADDRESS__) // sanitizers replace malloc
namespace {
std::atomic<uint64_t> allocations{0};
}
extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* malloc(size_t n) { return ++allocations, __libc_malloc(n); }
void* calloc(size_t n, size_t m) { return ++allocations, __libc_calloc(n, m); }
void* realloc(void* p, size_t n) { return ++allocations, __libc_realloc(p, n); }
}
#endif

namespace mural::testing {
namespace {

constexpr int kCalls = 100000;

// Encodes calls of several shapes into one chunk, which is reused from its start.
void encodeSmallCalls(ThreadState& t, std::byte* start) {
    const GLfloat values[4] = {1, 2, 3, 4};
    for (int i = 0; i < kCalls / 5; ++i) {
        if (t.chunkEnd - t.cursor < 4096) t.cursor = start;
        encode_glColor4ub(t, 1, 2, 3, 4);
        encode_glNormal3b(t, 1, 2, 3);
        encode_glVertex3f(t, 1, 2, 3);
        encode_glUniform4fv(t, 0, 1, DataArg::of(values, sizeof values));
        encode_glBindAttribLocation(t, 1, 2, DataArg::text("name"));
    }
}

#if !defined(__SANITIZE_ADDRESS__)
TEST(HotPath, allocatesNothing) {
    EncoderHarness harness;
    encode_glVertex3f(harness.thread(), 1, 2, 3); // takes the chunk
    std::byte* start = harness.thread().cursor;
    const uint64_t before = allocations;
    EXPECT_GT(before, 0u) << "the counter itself must work";
    encodeSmallCalls(harness.thread(), start);
    EXPECT_EQ(allocations, before);
    EXPECT_EQ(harness.chunksTaken(), 1u);
}
#endif

// Runs the calls in a child under strict seccomp: any system call except write and exit kills it.
int childUnderSeccomp(bool alsoCalls) {
    EncoderHarness harness;
    encode_glVertex3f(harness.thread(), 1, 2, 3);
    std::byte* start = harness.thread().cursor;
    const pid_t child = fork();
    if (child == 0) {
        if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) syscall(SYS_exit, 77);
        encodeSmallCalls(harness.thread(), start);
        if (alsoCalls) (void)getppid();
        syscall(SYS_exit, 0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status;
}

TEST(HotPath, makesNoSystemCall) {
    const int status = childUnderSeccomp(false);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "no seccomp here";
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "killed at a system call: status " << status;
    // Planted fault: one additional system call is detected.
    EXPECT_TRUE(WIFSIGNALED(childUnderSeccomp(true)));
}

} // namespace
} // namespace mural::testing
