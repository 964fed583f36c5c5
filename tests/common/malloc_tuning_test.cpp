// Memory that was freed, or reserved in advance, needs no new pages: a page fault takes 3 us in a virtual machine.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sys/resource.h>

#include "common/memory/malloc_tuning.hpp"
#include "tests/sanitized.hpp"

namespace mural {
namespace {

constexpr size_t kPageBytes = 4096, kBlockBytes = size_t{6} << 20;

// Returns the page faults of this thread while it allocates `sizeBytes` and writes to each page.
long faultsOf(size_t sizeBytes) {
    rusage before{}, after{};
    getrusage(RUSAGE_THREAD, &before);
    auto* const block = static_cast<volatile char*>(std::malloc(sizeBytes));
    for (size_t at = 0; at < sizeBytes; at += kPageBytes) block[at] = 1;
    getrusage(RUSAGE_THREAD, &after);
    std::free(const_cast<char*>(block));
    return after.ru_minflt - before.ru_minflt;
}

TEST(ReusedMemory, isMappedAtFirstAndLaterUse) {
    if (testing::kSanitized) GTEST_SKIP() << "the sanitizers' malloc is another one";
    keepFreedMemory();
    reserveMallocMemory(2 * kBlockBytes);
    constexpr long kFew = kBlockBytes / kPageBytes / 20;
    EXPECT_LT(faultsOf(kBlockBytes), kFew);
    EXPECT_LT(faultsOf(kBlockBytes), kFew);
}

} // namespace
} // namespace mural
