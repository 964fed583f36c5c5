#include <algorithm>
#include <cstring>
#include <lz4.h>
#include <vector>

#include "common/base/clock.hpp"
#include "streamcodec/wire/record_walk.hpp"
#include "tools/bench/stream/stream_coding.hpp"

namespace mural::bench {
namespace {

struct Command {
    size_t at = 0, sizeBytes = 0;
};
struct Frame {
    std::vector<std::byte> bytes;
    std::vector<Command> commands;
    [[nodiscard]] std::span<const std::byte> of(const Command& c) const {
        return std::span(bytes).subspan(c.at, c.sizeBytes);
    }
};

// memcmp instead of std::ranges::equal, which compares byte by byte: competitors are measured at their best.
bool isSame(std::span<const std::byte> a, std::span<const std::byte> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size()) == 0;
}

class DifferenceCoding final : public StreamCoding {
public:
    [[nodiscard]] std::string name() const override { return "difference + LZ4"; }

    // A chunk may end within a blob; the piece counts as a command.
    void packet(const StreamPacket& p) override {
        const size_t start = now_.bytes.size();
        now_.bytes.insert(now_.bytes.end(), p.payload.begin(), p.payload.end());
        wire::RecordWalk walk(p.payload);
        wire::RecordView r;
        size_t end = 0;
        while (walk.next(r)) {
            now_.commands.push_back({start + r.offset, r.sizeBytes});
            end = r.offset + r.sizeBytes;
        }
        if (end < p.payload.size()) now_.commands.push_back({start + end, p.payload.size() - end});
    }

    Result<uint64_t> frameEnds() override {
        const int64_t beganNs = threadCpuNowNs();
        left_.clear();
        uint32_t same = 0;
        for (size_t i = 0; i < now_.commands.size(); ++i) {
            const auto command = now_.of(now_.commands[i]);
            if (i < before_.commands.size() && isSame(command, before_.of(before_.commands[i]))) {
                ++same;
                continue;
            }
            number(same);
            same = 0;
            left_.insert(left_.end(), command.begin(), command.end());
        }
        number(same);
        if (left_.size() > LZ4_MAX_INPUT_SIZE) return Error{"a frame is too large for LZ4"};
        out_.resize(static_cast<size_t>(LZ4_compressBound(static_cast<int>(left_.size()))));
        const int bytes =
            LZ4_compress_default(reinterpret_cast<const char*>(left_.data()), reinterpret_cast<char*>(out_.data()),
                                 static_cast<int>(left_.size()), static_cast<int>(out_.size()));
        cpuNs_ += threadCpuNowNs() - beganNs;
        std::swap(before_, now_);
        now_.bytes.clear();
        now_.commands.clear();
        if (bytes <= 0) return Error{"LZ4 has failed"};
        return static_cast<uint64_t>(bytes);
    }
    [[nodiscard]] int64_t cpuNs() const override { return cpuNs_; }

private:
    void number(uint32_t n) { // as a varint
        for (; n >= 128; n >>= 7) left_.push_back(static_cast<std::byte>(n | 128));
        left_.push_back(static_cast<std::byte>(n));
    }

    Frame before_, now_;
    std::vector<std::byte> left_, out_;
    int64_t cpuNs_ = 0;
};

} // namespace

std::unique_ptr<StreamCoding> differenceCoding() { return std::make_unique<DifferenceCoding>(); }

} // namespace mural::bench
