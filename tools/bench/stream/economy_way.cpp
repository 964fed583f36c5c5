#include <cstring>
#include <deque>
#include <utility>
#include <vector>

#include "common/clock.hpp"
#include "economy/unpacker.hpp"
#include "nodes/head/stream_economy.hpp"
#include "streamcodec/wire.hpp"
#include "tools/bench/stream/ways.hpp"

namespace mural::bench {
namespace {

class EconomyWay final : public Way {
public:
    EconomyWay(std::unique_ptr<StreamEconomy> economy, const economy::Limits& limits) : economy_(std::move(economy)), unpacker_(limits) {
        economy_->sendBy([this] { take(); });
        economy_->holdNothing(); // what is unpacked is compared with what came
    }

    [[nodiscard]] std::string name() const override { return "economy"; }

    void packet(const StreamPacket& p) override { sent_.push_back({p.stream, {p.payload.begin(), p.payload.end()}}); }

    [[nodiscard]] int64_t cpuNs() const override { return cpuNs_; }

    Result<uint64_t> frameEnds() override {
        const int64_t beganNs = threadCpuNowNs();
        for (const Sent& s : sent_) economy_->add(s.stream, s.payload);
        if (!economy_->empty()) take();
        cpuNs_ += threadCpuNowNs() - beganNs;
        for (const std::vector<std::byte>& batch : batches_) unpack(batch);
        batches_.clear();
        if (wrong_.empty() && !sent_.empty()) wrong_ = "packets are missing when they have been unpacked";
        if (!wrong_.empty()) return Error{wrong_};
        return std::exchange(bytes_, 0);
    }

private:
    struct Sent {
        uint32_t stream;
        std::vector<std::byte> payload;
    };

    void take() {
        auto batch = economy_->take();
        if (!batch) {
            wrong_ = batch.error().message;
            return;
        }
        bytes_ += batch->size();
        batches_.emplace_back(batch->begin(), batch->end());
    }

    void unpack(std::span<const std::byte> batch) {
        economy::BatchHeadReader head;
        size_t at = 0;
        while (at < batch.size() && !head.add(batch[at++])) {}
        auto sections = decoder_.decode(head.head(), batch.subspan(at));
        if (!sections) {
            wrong_ = sections.error().message;
            return;
        }
        unpacker_.begin(*sections);
        while (true) {
            uint32_t stream = 0;
            std::span<const std::byte> payload;
            auto more = unpacker_.next(stream, payload);
            if (!more) wrong_ = more.error().message;
            if (!more || !*more) return;
            compare(stream, payload);
        }
    }

    void compare(uint32_t stream, std::span<const std::byte> payload) {
        if (sent_.empty() || sent_.front().stream != stream || sent_.front().payload.size() != payload.size() ||
            std::memcmp(sent_.front().payload.data(), payload.data(), payload.size()) != 0)
            wrong_ = "a packet is another one when it has been unpacked";
        if (!sent_.empty()) sent_.pop_front();
    }

    std::unique_ptr<StreamEconomy> economy_;
    economy::BatchDecoder decoder_;
    economy::Unpacker unpacker_;
    std::deque<Sent> sent_;                      // of the frame
    std::vector<std::vector<std::byte>> batches_; // that it has become
    int64_t cpuNs_ = 0;
    std::string wrong_;
    uint64_t bytes_ = 0;
};

} // namespace

Result<std::unique_ptr<Way>> economyWay(uint64_t storeBytes) {
    economy::Limits limits;
    limits.storeBytes = storeBytes;
    auto economy = StreamEconomy::open(limits);
    if (!economy) return economy.error();
    return std::unique_ptr<Way>(new EconomyWay(std::move(*economy), limits));
}

} // namespace mural::bench
