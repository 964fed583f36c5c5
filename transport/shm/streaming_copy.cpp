#include "transport/shm/streaming_copy.hpp"

#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace mural {

#if defined(__SSE2__)

namespace {

constexpr size_t kLineBytes = 64;

// Copies whole cache lines, each as one transfer. Requires `to` to be aligned to a cache line.
void streamLines(std::byte* to, const std::byte* from, size_t lines) {
    auto* target = reinterpret_cast<__m128i*>(to);
    const auto* source = reinterpret_cast<const __m128i*>(from);
    for (size_t i = 0; i < lines; ++i, target += 4, source += 4) {
        const __m128i a = _mm_loadu_si128(source);
        const __m128i b = _mm_loadu_si128(source + 1);
        const __m128i c = _mm_loadu_si128(source + 2);
        const __m128i d = _mm_loadu_si128(source + 3);
        _mm_stream_si128(target, a);
        _mm_stream_si128(target + 1, b);
        _mm_stream_si128(target + 2, c);
        _mm_stream_si128(target + 3, d);
    }
    _mm_sfence(); // a release store does not order streaming stores
}

} // namespace

void streamingCopy(std::byte* to, const std::byte* from, size_t sizeBytes) {
    if (sizeBytes < kStreamingCopyBytes) {
        std::memcpy(to, from, sizeBytes);
        return;
    }
    const size_t head = (kLineBytes - reinterpret_cast<uintptr_t>(to) % kLineBytes) % kLineBytes;
    const size_t body = (sizeBytes - head) / kLineBytes * kLineBytes;
    std::memcpy(to, from, head);
    streamLines(to + head, from + head, body / kLineBytes);
    std::memcpy(to + head + body, from + head + body, sizeBytes - head - body);
}

#else

void streamingCopy(std::byte* to, const std::byte* from, size_t sizeBytes) { std::memcpy(to, from, sizeBytes); }

#endif

} // namespace mural
