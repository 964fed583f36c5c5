// The last message of a node: totals of the session for the head's report.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

namespace mural {

class BarrierPart;
class ExchangePart;
class PictureSender;
class StreamPlayer;

// Parts of the node that have totals; null: the node has no such part.
struct GoodbyeParts {
    const StreamPlayer* player = nullptr;
    const ExchangePart* exchange = nullptr;
    const PictureSender* sender = nullptr;
    const BarrierPart* barrier = nullptr;
    int barrierMembers = 0;
    uint64_t receivedBytes = 0; // from the head
};

[[nodiscard]] nlohmann::json goodbyeOf(const GoodbyeParts& parts);

} // namespace mural
