#include <utility>
#include <vector>

#include "common/clock.hpp"
#include "holding/holder.hpp"
#include "streamcodec/wire.hpp"
#include "tools/bench/stream/ways.hpp"

namespace mural::bench {
namespace {

constexpr uint64_t kMostHeldBytes = uint64_t{256} << 20; // as the head's

class HoldingWay final : public Way {
public:
    [[nodiscard]] std::string name() const override { return "holding"; }
    void packet(const StreamPacket& p) override { came_.push_back({p.stream, {p.payload.begin(), p.payload.end()}}); }
    [[nodiscard]] int64_t cpuNs() const override { return cpuNs_; }

    Result<uint64_t> frameEnds() override {
        const uint64_t before = holder_.counts().outBytes;
        const int64_t beganNs = threadCpuNowNs();
        for (const Came& c : came_)
            if (wire::clientOf(c.stream) != 0) holder_.add(c.stream, c.payload);
        cpuNs_ += threadCpuNowNs() - beganNs;
        came_.clear();
        return holder_.counts().outBytes - before;
    }

private:
    struct Came {
        uint32_t stream;
        std::vector<std::byte> payload;
    };

    holding::Holder holder_{kMostHeldBytes, [](uint32_t, std::span<const std::byte>, const recording::Walked*) {}};
    std::vector<Came> came_; // of the frame
    int64_t cpuNs_ = 0;
};

} // namespace

std::unique_ptr<Way> holdingWay() { return std::make_unique<HoldingWay>(); }

} // namespace mural::bench
