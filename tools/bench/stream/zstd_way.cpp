#include <vector>
#include <zstd.h>

#include "common/clock.hpp"
#include "tools/bench/stream/ways.hpp"

namespace mural::bench {
namespace {

class ZstdWay final : public Way {
public:
    explicit ZstdWay(int level) : level_(level), compressor_(ZSTD_createCCtx(), ZSTD_freeCCtx) {}

    [[nodiscard]] std::string name() const override { return "zstd -" + std::to_string(level_); }
    void packet(const StreamPacket& p) override { frame_.insert(frame_.end(), p.payload.begin(), p.payload.end()); }

    Result<uint64_t> frameEnds() override {
        out_.resize(ZSTD_compressBound(frame_.size()));
        const int64_t beganNs = threadCpuNowNs();
        const size_t bytes = ZSTD_compressCCtx(compressor_.get(), out_.data(), out_.size(), frame_.data(), frame_.size(), level_);
        cpuNs_ += threadCpuNowNs() - beganNs;
        frame_.clear();
        if (ZSTD_isError(bytes)) return Error{std::string("Zstandard: ") + ZSTD_getErrorName(bytes)};
        return bytes;
    }
    [[nodiscard]] int64_t cpuNs() const override { return cpuNs_; }

private:
    const int level_;
    std::unique_ptr<ZSTD_CCtx, size_t (*)(ZSTD_CCtx*)> compressor_;
    std::vector<std::byte> frame_, out_;
    int64_t cpuNs_ = 0;
};

} // namespace

std::unique_ptr<Way> zstdWay(int level) { return std::make_unique<ZstdWay>(level); }

} // namespace mural::bench
