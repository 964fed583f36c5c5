// The latest proofs of the nodes that their outputs are alive (streamcodec/wire/output_proof.hpp). Thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "streamcodec/wire/output_proof.hpp"

namespace mural {

class OutputProofs {
public:
    struct Proof {
        int node = 0;
        int64_t requestedNs = 0; // the node was alive after this time; monotonic clock of the head
        wire::OutputProofMessage message{};
    };

    // Begins a request. Returns its number; nullopt: the previous one is too recent.
    std::optional<uint32_t> begin(int64_t nowNs);
    // Takes the reply of a node. Replies to forgotten requests have no effect.
    void add(int node, const wire::OutputProofMessage& message);
    // The latest proof of each node, by number. Nodes keep it when they are lost.
    [[nodiscard]] std::vector<Proof> latest() const;

private:
    static constexpr int64_t kSmallestIntervalNs = 500'000'000;
    static constexpr size_t kRequests = 600; // a node that replies later counts as silent

    mutable std::mutex mutex_; // guards the members below
    uint32_t lastNumber_ = 0;
    int64_t lastNs_ = 0;
    std::map<uint32_t, int64_t> requestedNs_; // by number
    std::map<int, Proof> byNode_;
};

} // namespace mural
