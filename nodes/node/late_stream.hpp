// A multicast group that is joined while packets still come another way: what comes by it is kept until it is known where in
// it to go on. Nobody else waits meanwhile: who does not read holds up the writer.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "transport/connection.hpp"
#include "transport/rsp/group.hpp"

namespace mural {

class LateStream {
public:
    // Joins in a thread of its own. `failed`: with the reason, by that thread, when it does not get in, or is told nothing for
    // so long that it leaves.
    LateStream(rsp::GroupOptions options, std::function<void(const std::string&)> failed);
    ~LateStream();
    LateStream(const LateStream&) = delete;
    LateStream& operator=(const LateStream&) = delete;

    // The stream without its first `skipBytes`. Once. Errors: it is no member; less than that came before the deadline.
    Result<std::unique_ptr<Connection>> goOn(uint64_t skipBytes, Deadline deadline);

private:
    void work();
    bool readSome();

    const rsp::GroupOptions options_;
    const std::function<void(const std::string&)> failed_;
    std::unique_ptr<rsp::Group> group_; // work()'s, then goOn()'s
    std::vector<std::byte> come_;       // as well
    std::atomic<bool> stop_{false};
    std::thread thread_; // last
};

} // namespace mural
