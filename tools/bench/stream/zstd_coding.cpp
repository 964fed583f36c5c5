#include <cstring>
#include <vector>
#include <zstd.h>

#include "common/base/clock.hpp"
#include "tools/bench/stream/stream_coding.hpp"

namespace mural::bench {
namespace {

class ZstdCoding final : public StreamCoding {
public:
    explicit ZstdCoding(int level) : level_(level), compressor_(ZSTD_createCCtx(), ZSTD_freeCCtx) {}

    [[nodiscard]] std::string name() const override { return "zstd -" + std::to_string(level_); }
    void packet(const StreamPacket& p) override {
        packets_.emplace_back(p.payload.begin(), p.payload.end());
        frameBytes_ += p.payload.size();
    }

    // Assembles the packets of a frame first, because it is compressed as a whole.
    Result<uint64_t> frameEnds() override {
        out_.resize(ZSTD_compressBound(frameBytes_));
        frame_.resize(frameBytes_); // commits the memory before the measurement
        const int64_t beganNs = threadCpuNowNs();
        size_t at = 0;
        for (const auto& packet : packets_) {
            std::memcpy(frame_.data() + at, packet.data(), packet.size());
            at += packet.size();
        }
        const size_t bytes =
            ZSTD_compressCCtx(compressor_.get(), out_.data(), out_.size(), frame_.data(), frame_.size(), level_);
        cpuNs_ += threadCpuNowNs() - beganNs;
        packets_.clear();
        frameBytes_ = 0;
        if (ZSTD_isError(bytes)) return Error{std::string("Zstandard: ") + ZSTD_getErrorName(bytes)};
        return bytes;
    }
    [[nodiscard]] int64_t cpuNs() const override { return cpuNs_; }

private:
    const int level_;
    std::unique_ptr<ZSTD_CCtx, size_t (*)(ZSTD_CCtx*)> compressor_;
    std::vector<std::vector<std::byte>> packets_;
    size_t frameBytes_ = 0;
    std::vector<std::byte> frame_, out_;
    int64_t cpuNs_ = 0;
};

} // namespace

std::unique_ptr<StreamCoding> zstdCoding(int level) { return std::make_unique<ZstdCoding>(level); }

} // namespace mural::bench
