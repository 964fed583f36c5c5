// How messages get from one node of a picture to another, by rank.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "nodes/exchange/part_sender.hpp"

namespace mural {

class PartRoutes {
public:
    virtual ~PartRoutes() = default;

    // Does not wait for the other to read. Errors of both: the other end is gone, or nothing came by the deadline; it is gone then, and
    // later calls for it fail at once.
    virtual Result<void> send(int rank, std::vector<std::byte> message, Deadline deadline) = 0;
    // The next message of that rank; a larger one is an error.
    virtual Result<std::vector<std::byte>> receive(int rank, size_t mostBytes, Deadline deadline) = 0;
    // Of the way to that rank, since it was last asked.
    virtual LinkTransfer takeTransfer(int rank) = 0;
    // It has sent what makes no sense.
    virtual void giveUp(int rank) = 0;
    // The node of that rank is another from here on: the one that was started again for the `life`th time. Is it not connected, it is gone.
    virtual void renew(int rank, uint32_t life) = 0;
};

} // namespace mural
