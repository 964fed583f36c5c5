#include "nodes/head/stream_economy.hpp"

#include "common/clock.hpp"
#include "streamcodec/wire.hpp"

namespace mural {
namespace {

constexpr uint64_t kFullStagedBytes = uint64_t{64} * 1024; // as much as goes at once without economy
constexpr uint64_t kFullRawBytes = uint64_t{4} << 20;      // so much a node unpacks in a millisecond or two

} // namespace

Result<std::unique_ptr<StreamEconomy>> StreamEconomy::open(const economy::Limits& limits) {
    std::unique_ptr<StreamEconomy> economy(new StreamEconomy(limits));
    if (!economy->packer_.ready()) return Error{"no memory for a store of " + std::to_string(limits.storeBytes >> 20) + " MiB; give a smaller one by --store"};
    return economy;
}

StreamEconomy::StreamEconomy(const economy::Limits& limits) : packer_(limits), encoder_(threadCpuNowNs) {}

void StreamEconomy::add(uint32_t stream, std::span<const std::byte> payload) {
    const int64_t beganNs = threadCpuNowNs();
    packer_.add(stream, payload);
    ++packets_;
    encodeNs_ += static_cast<uint64_t>(threadCpuNowNs() - beganNs);
}

bool StreamEconomy::full() { return packer_.stagedBytes() >= kFullStagedBytes || packer_.rawBytes() >= kFullRawBytes; }

Result<std::span<const std::byte>> StreamEconomy::take() {
    const int64_t beganNs = threadCpuNowNs();
    auto batch = encoder_.encode(packer_.sections(), link_.nsPerByte());
    packer_.clear();
    packets_ = 0;
    encodeNs_ += static_cast<uint64_t>(threadCpuNowNs() - beganNs);
    if (batch) wireBytes_ += sizeof(wire::PacketHeader) + batch->size();
    publishCounts();
    return batch;
}

void StreamEconomy::publishCounts() {
    const economy::PackerCounts& c = packer_.counts();
    const auto set = [](std::atomic<uint64_t>& to, uint64_t value) { to.store(value, std::memory_order_relaxed); };
    set(published_.packets, c.packets);
    set(published_.records, c.records);
    set(published_.rawBytes, c.rawBytes);
    set(published_.stagedBytes, c.stagedBytes);
    set(published_.storeHits, c.storeHits);
    set(published_.newPages, c.newPages);
    set(published_.patches, c.patches);
    set(published_.wireBytes, wireBytes_);
    set(published_.encodeNs, encodeNs_);
}

EconomyCounts StreamEconomy::counts() const {
    const auto of = [](const std::atomic<uint64_t>& from) { return from.load(std::memory_order_relaxed); };
    EconomyCounts c;
    c.on = true;
    c.packer = {of(published_.packets), of(published_.records), of(published_.rawBytes), of(published_.stagedBytes), of(published_.storeHits), of(published_.newPages), of(published_.patches)};
    c.wireBytes = of(published_.wireBytes);
    c.encodeNs = of(published_.encodeNs);
    return c;
}

} // namespace mural
