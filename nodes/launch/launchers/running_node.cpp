#include "nodes/launch/launchers/running_node.hpp"

#include <poll.h>

namespace mural {

std::optional<std::string> RunningNode::waitEnded(Deadline deadline) {
    constexpr int kSliceMs = 5;
    while (true) {
        if (auto how = ended()) return how;
        if (deadline.passed()) return std::nullopt;
        poll(nullptr, 0, kSliceMs);
    }
}

} // namespace mural
