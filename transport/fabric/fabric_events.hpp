// libfabric's event queue: connection requests and state changes.
#pragma once

#include <cstddef>
#include <rdma/fi_eq.h>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "transport/fabric/fabric_handle.hpp"

namespace mural::fabric {

struct Event {
    enum class Kind { None, Request, Connected, Shutdown, Failed };
    Kind kind = Kind::None;                                 // None: the deadline passed
    Info info;                                              // for Request
    std::vector<std::byte> greeting;                        // data of a Request or Connected
    long code = 0;                                          // for Failed
    [[nodiscard]] bool passing() const { return code > 0; } // Failed: a single request; negative: the queue itself
};

class EventQueue {
public:
    static Result<EventQueue> open(const SharedFabric& fabric);

    // Returns the next event; with a passed deadline it only polls.
    Event next(Deadline deadline);
    [[nodiscard]] fid_eq* get() const { return queue_.get(); }
    [[nodiscard]] int descriptor() const { return descriptor_; }

private:
    Event poll();

    SharedFabric fabric_;
    Handle<fid_eq> queue_;
    int descriptor_ = -1;
};

} // namespace mural::fabric
