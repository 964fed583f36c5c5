// When a group's thread sees to its sockets, because nobody who waits has done so for a while. Whoever has led pushes that
// ahead, from its own thread: a system call now and then, while the group's thread sleeps on. A timer of that thread's own
// would wake it each time, for nothing, where leaders always come back.
//
// Called with the group's lock held.
#pragma once

#include <cstdint>

#include "common/result.hpp"
#include "transport/file_descriptor.hpp"

namespace mural::rsp {

class TakeOverTimer {
public:
    static Result<TakeOverTimer> open();

    // Readable when it is time.
    [[nodiscard]] int descriptor() const { return timer_.get(); }
    // It is time between half of this from now on and all of it; what was set before is over.
    void push(int64_t nowNs, int64_t afterNs);
    // A leader sleeps until then, and looks again: it is not time before that.
    void keepBehind(int64_t untilNs, int64_t afterNs);
    // Whether it is time: it may have been pushed ahead since the descriptor was readable.
    bool rang(int64_t nowNs);

private:
    TakeOverTimer() = default;
    void set(int64_t atNs);

    FileDescriptor timer_;
    int64_t atNs_ = INT64_MIN; // not set
};

} // namespace mural::rsp
