// Selects the mode of each batch: delta coding, or plain records for a compressor whose window contains previous
// frames. Delta coding gives the smallest stream for most programs, but takes several times as long where much changes.
// Criterion: minimal delivery time, from measured CPU time, size, and link rate. Has no clock of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mural::delta {

class ModeSelector {
public:
    // A batch here covers everything up to the point where a program has published nothing more: about a frame. Returns
    // the mode of the next batch.
    [[nodiscard]] bool plain() const { return plain_; }
    // Returns true if the next batch must be timed. Reading a thread's CPU clock is a system call and takes as long as
    // coding a small frame.
    [[nodiscard]] bool wantsTime() const;
    // Reports a batch without a measured time.
    void unmeasured() {
        ++batches_;
        isFirst_ = false;
    }
    // Reports a delta-coded batch whose short records were mostly sent plain after many new ones (NoveltyDetector). It
    // does not reveal the cost of delta mode.
    void mostlyPlain();
    // Reports a batch. pageBytes: the part of rawBytes in long records, which are coded in either mode.
    void measured(uint64_t rawBytes, uint64_t pageBytes, uint64_t wireBytes, int64_t ns, double linkNsPerByte);

private:
    enum Mode : size_t { Dictionary, Plain };
    // Moving average over recent batches.
    struct Cost {
        double ns = 0, rawBytes = 0, wireBytes = 0, encodeNs = 0, batches = 0;
        double minNs = 0; // shortest encoding time
        [[nodiscard]] double perByte() const { return rawBytes > 0 ? ns / rawBytes : 0; }
    };
    void tryOther();
    [[nodiscard]] bool isDearAtOnce(uint64_t rawBytes, int64_t ns) const;
    void decide();

    static constexpr uint32_t kFirstTry = 4, kMaxBetween = 1024;
    std::array<Cost, 2> costs_;
    bool plain_ = false;
    bool trying_ = false;
    bool cheap_ = false;         // a recent batch was cheap
    uint32_t batches_ = 0;       // since the mode was selected
    uint32_t until_ = kFirstTry; // number of batches after which the other mode is tried
    double decidedBy_ = 0;       // cost per byte at the last decision
    bool isFirst_ = true;        // no batch so far
    double firstNsPerByte_ = 0;  // of the first batch, which is mostly new
    bool isByOne_ = false;       // the cost of delta mode is known from a single early batch
    bool isByLeftOut_ = false;   // plain mode without knowledge of the cost of delta mode
};

} // namespace mural::delta
