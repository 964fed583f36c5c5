#include "nodes/session/range_assignment.hpp"

#include <cstring>

namespace mural {

std::vector<std::byte> bytesOf(const RangeAssignment& shares) {
    const uint32_t head[] = {shares.number, static_cast<uint32_t>(shares.ofNodes.size())};
    std::vector<std::byte> bytes(sizeof head + shares.ofNodes.size() * 2 * sizeof(double));
    std::memcpy(bytes.data(), head, sizeof head);
    for (size_t i = 0; i < shares.ofNodes.size(); ++i) {
        const double edges[] = {shares.ofNodes[i].start, shares.ofNodes[i].end};
        std::memcpy(bytes.data() + sizeof head + i * sizeof edges, edges, sizeof edges);
    }
    return bytes;
}

std::optional<RangeAssignment> sharesOf(std::span<const std::byte> bytes) {
    uint32_t head[2] = {};
    if (bytes.size() < sizeof head) return {};
    std::memcpy(head, bytes.data(), sizeof head);
    bytes = bytes.subspan(sizeof head);
    double edges[2] = {};
    if (bytes.size() != head[1] * sizeof edges) return {};
    RangeAssignment shares;
    shares.number = head[0];
    for (; !bytes.empty(); bytes = bytes.subspan(sizeof edges)) {
        std::memcpy(edges, bytes.data(), sizeof edges);
        if (!(edges[0] >= 0 && edges[0] <= edges[1] && edges[1] <= 1)) return {}; // also rejects NaN
        shares.ofNodes.push_back({edges[0], edges[1]});
    }
    return shares;
}

} // namespace mural
