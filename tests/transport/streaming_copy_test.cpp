// Copies into memory that another core reads: exactly the requested bytes.
#include "transport/shm/streaming_copy.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

#include "tests/transport/linked_pair.hpp"

namespace mural::test {

// Covers every alignment of both sides, around the size from which stores are streamed.
TEST(StreamingCopy, copiesExactlyTheRequestedBytes) {
    constexpr size_t kMargin = 128;
    for (const size_t size : {size_t{0}, size_t{1}, kStreamingCopyBytes - 1, kStreamingCopyBytes,
                              kStreamingCopyBytes + 1, 3 * kStreamingCopyBytes + 63}) {
        std::vector<std::byte> from(size + kMargin);
        ByteStream(size).fill(from);
        for (size_t shift = 0; shift < 64; shift += 7) {
            for (size_t at = 0; at < 64; ++at) {
                std::vector<std::byte> to(size + kMargin, std::byte{0xa5});
                std::vector<std::byte> right = to;
                std::copy_n(from.begin() + static_cast<ptrdiff_t>(shift), size,
                            right.begin() + static_cast<ptrdiff_t>(at));
                streamingCopy(to.data() + at, from.data() + shift, size);
                ASSERT_EQ(to, right) << size << " bytes to " << at << " from " << shift;
            }
        }
    }
}

} // namespace mural::test
