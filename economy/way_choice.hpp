// Whether the short records of a batch are looked at, or go plain to the compressor, whose window has the frames before: looking makes most
// streams smallest, but where much changes it takes several times as long. By which batches are with the nodes soonest: measured
// time, size on the wire, and how fast the link is. No clock of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mural::economy {

class WayChoice {
public:
    // Batches that are counted here are those up to where a program has published no more: about a frame.
    // Of the next batch.
    [[nodiscard]] bool plain() const { return plain_; }
    // Whether the time of the next batch must be known: reading a thread's clock is a system call, and takes as long as looking at a small frame.
    [[nodiscard]] bool wantsTime() const;
    // The batch has gone so, in a time that nobody has measured.
    void unmeasured() {
        ++batches_;
        isFirst_ = false;
    }
    // The batch was to be looked at, but most of its short records went plain behind many new ones (NewRecords): it says nothing of what looking costs.
    void leftOut();
    // The batch has gone so. pageBytes: of rawBytes, in long records, which are looked at either way.
    void measured(uint64_t rawBytes, uint64_t pageBytes, uint64_t wireBytes, int64_t ns, double linkNsPerByte);

private:
    enum Way : size_t { Looked, Plain };
    // Of the last batches, the older the less.
    struct Cost {
        double ns = 0, rawBytes = 0, wireBytes = 0, encodeNs = 0, batches = 0;
        double leastNs = 0; // that one took to encode
        [[nodiscard]] double perByte() const { return rawBytes > 0 ? ns / rawBytes : 0; }
    };
    void tryOther();
    [[nodiscard]] bool isDearAtOnce(uint64_t rawBytes, int64_t ns) const;
    void decide();

    static constexpr uint32_t kFirstTry = 4, kMostBetween = 1024;
    std::array<Cost, 2> costs_;
    bool plain_ = false;
    bool trying_ = false;
    bool cheap_ = false; // one batch of late
    uint32_t batches_ = 0; // since the way was taken
    uint32_t until_ = kFirstTry; // so many, the other way is tried
    double decidedBy_ = 0; // cost per byte when it was
    bool isFirst_ = true;      // no batch has been yet
    double firstNsPerByte_ = 0; // of the first, in which most is new
    bool isByOne_ = false;      // what looking costs is known of one of the first only
    bool isByLeftOut_ = false; // plain: nobody knows what looking costs
};

} // namespace mural::economy
