// Buffers into which the socket receives the next datagrams, so payloads are not copied again.
#pragma once

#include <cstddef>
#include <span>

namespace mural::rsp {

constexpr size_t kMaxAtOnce = 32; // datagrams per receive call: few enough to stay in the processor's cache

struct ReceiveBuffers {
    size_t bufferBytes = 0;              // size of each buffer: a whole datagram including its header
    std::span<std::byte* const> buffers; // one datagram each, in order of arrival; empty: none provided
};

} // namespace mural::rsp
