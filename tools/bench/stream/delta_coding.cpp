#include <cstring>
#include <deque>
#include <utility>
#include <vector>

#include "common/base/clock.hpp"
#include "streamcodec/delta/delta_decoder.hpp"
#include "nodes/head/broadcast/delta_stream.hpp"
#include "tools/bench/stream/stream_coding.hpp"

namespace mural::bench {
namespace {

class DeltaCoding final : public StreamCoding {
public:
    DeltaCoding(std::unique_ptr<DeltaStream> deltaStream, const delta::Limits& limits, bool filters)
        : deltaStream_(std::move(deltaStream)), deltaDecoder_(limits), filters_(filters) {
        deltaStream_->sendBy([this] { take(); });
        if (!filters) deltaStream_->disableFilter(); // decoded packets are compared with the originals
    }

    [[nodiscard]] std::string name() const override { return filters_ ? "sent" : "all packed"; }

    void packet(const StreamPacket& p) override { sent_.push_back({p.stream, {p.payload.begin(), p.payload.end()}}); }

    [[nodiscard]] int64_t cpuNs() const override { return cpuNs_; }

    Result<uint64_t> frameEnds() override {
        const int64_t beganNs = threadCpuNowNs();
        for (const Sent& s : sent_) deltaStream_->add(s.stream, s.payload);
        if (!deltaStream_->empty()) take();
        cpuNs_ += threadCpuNowNs() - beganNs;
        sent_.clear();
        if (!wrong_.empty()) return Error{wrong_};
        return std::exchange(bytes_, 0);
    }

    Result<void> comesOut(const StreamPacket& p) override {
        if (filters_) return {};
        uint32_t stream = 0;
        std::span<const std::byte> payload;
        while (true) {
            if (unpacking_) {
                auto more = deltaDecoder_.next(stream, payload);
                if (!more) return more.error();
                unpacking_ = *more;
                if (unpacking_) break;
            }
            if (batches_.empty()) return Error{"packets are missing when they have been unpacked"};
            if (auto begun = unpack(); !begun) return begun;
        }
        if (stream != p.stream || payload.size() != p.payload.size() ||
            std::memcmp(payload.data(), p.payload.data(), payload.size()) != 0)
            return Error{"a packet is another one when it has been unpacked"};
        return {};
    }

private:
    struct Sent {
        uint32_t stream;
        std::vector<std::byte> payload;
    };

    void take() {
        auto batch = deltaStream_->take();
        if (!batch) {
            wrong_ = batch.error().message;
            return;
        }
        bytes_ += batch->size();
        if (!filters_) batches_.emplace_back(batch->begin(), batch->end());
    }

    Result<void> unpack() {
        batch_ = std::move(batches_.front()); // decoded packets refer to it
        batches_.pop_front();
        delta::BatchHeadReader head;
        size_t at = 0;
        while (at < batch_.size() && !head.add(batch_[at++])) {}
        auto sections = decoder_.decode(head.head(), std::span(batch_).subspan(at));
        if (!sections) return sections.error();
        deltaDecoder_.begin(*sections);
        unpacking_ = true;
        return {};
    }

    std::unique_ptr<DeltaStream> deltaStream_;
    delta::BatchDecoder decoder_;
    delta::DeltaDecoder deltaDecoder_;
    std::vector<Sent> sent_;                     // of the frame
    std::deque<std::vector<std::byte>> batches_; // not decoded yet
    std::vector<std::byte> batch_;               // being decoded
    const bool filters_;                         // with the filter, output differs from input and is not compared
    bool unpacking_ = false;
    int64_t cpuNs_ = 0;
    std::string wrong_;
    uint64_t bytes_ = 0;
};

} // namespace

static Result<std::unique_ptr<StreamCoding>> deltaCoding(uint64_t cacheBytes, bool filters) {
    delta::Limits limits;
    limits.cacheBytes = cacheBytes;
    auto deltaStream = DeltaStream::open(limits);
    if (!deltaStream) return deltaStream.error();
    return std::unique_ptr<StreamCoding>(new DeltaCoding(std::move(*deltaStream), limits, filters));
}

Result<std::unique_ptr<StreamCoding>> filteredDeltaCoding(uint64_t cacheBytes) { return deltaCoding(cacheBytes, true); }
Result<std::unique_ptr<StreamCoding>> unfilteredDeltaCoding(uint64_t cacheBytes) {
    return deltaCoding(cacheBytes, false);
}

} // namespace mural::bench
