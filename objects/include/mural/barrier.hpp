// Barriers between the processes of a session.
#pragma once

#include <cstdint>
#include <memory>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"

namespace mural {

// All members continue together. Thread safety: one thread at a time.
class Barrier {
public:
    // Used by the session; objects/ends/barrier_ends.hpp.
    class Member;
    // Used by the session.
    explicit Barrier(std::shared_ptr<Member> member) : member_(std::move(member)) {}

    // Waits until all members have entered, and returns their number. Lost members are not waited for. Errors: the
    // deadline, which names the missing members; the session is over. After an error the member has left the round.
    Result<uint32_t> enter(Deadline deadline = Deadline::inMs(5000));

private:
    std::shared_ptr<Member> member_;
};

} // namespace mural
