// Where a reader wants the next datagrams to be put as they are received, so that nobody copies their payloads again.
#pragma once

#include <cstddef>
#include <span>

namespace mural::rsp {

constexpr size_t kMostAtOnce = 32; // datagrams that a socket brings by one call: few enough to be in the processor's cache when they are read

struct Landing {
    size_t placeBytes = 0;              // that each place has: for a whole datagram, from its head on
    std::span<std::byte* const> places; // for one datagram each, in the order in which they come; none: nothing is wanted
};

} // namespace mural::rsp
