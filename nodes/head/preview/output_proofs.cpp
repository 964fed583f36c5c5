#include "nodes/head/preview/output_proofs.hpp"

namespace mural {

std::optional<uint32_t> OutputProofs::begin(int64_t nowNs) {
    const std::lock_guard lock(mutex_);
    if (lastNumber_ != 0 && nowNs - lastNs_ < kSmallestIntervalNs) return std::nullopt;
    lastNs_ = nowNs;
    requestedNs_[++lastNumber_] = nowNs;
    if (requestedNs_.size() > kRequests) requestedNs_.erase(requestedNs_.begin());
    return lastNumber_;
}

void OutputProofs::add(int node, const wire::OutputProofMessage& message) {
    const std::lock_guard lock(mutex_);
    const auto requested = requestedNs_.find(message.number);
    if (requested == requestedNs_.end()) return;
    byNode_[node] = {node, requested->second, message};
}

std::vector<OutputProofs::Proof> OutputProofs::latest() const {
    const std::lock_guard lock(mutex_);
    std::vector<Proof> proofs;
    for (const auto& [node, proof] : byNode_) proofs.push_back(proof);
    return proofs;
}

} // namespace mural
