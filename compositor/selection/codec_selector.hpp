// Selects, for one link, the codec with minimal delivery time per piece of a picture. Decides from reports about
// previous pieces only: no clock, no threads, deterministic.
//
// Delivery time: encoding, transfer, decoding. Each is estimated per class of pieces and codec. To measure codecs that
// are not selected, the caller encodes and decodes a few pieces with another codec too, and discards the result. Both
// results refer to the same piece, so differences between pieces do not matter.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compositor/selection/tile_class.hpp"

namespace mural::compositor {

// Combination of a piece's three times.
enum class Overlap : uint8_t {
    Serial,    // sum: optimises latency
    Pipelined, // maximum: pieces are encoded, transferred and decoded concurrently
};

struct SelectorOptions {
    Overlap overlap = Overlap::Pipelined;
    double measureShare = 0.01;      // fraction of the time for measuring other codecs
    double startBytesPerSec = 125e6; // assumed link rate until it is measured
};

class CodecSelector {
public:
    // Candidate names, including "raw", which wins where no codec pays off. Only lossless ones
    // (CodecRegistry::losslessFor), unless the user named others. Tried in this order.
    explicit CodecSelector(std::vector<std::string> codecs, SelectorOptions options = {});

    // Indices of codecs: one for the next piece of this class, and optionally one to measure.
    struct Choice {
        size_t codec = 0;
        std::optional<size_t> measure;
    };
    [[nodiscard]] Choice choose(const TileClass& tile, uint64_t rawBytes);
    [[nodiscard]] const std::string& name(size_t codec) const { return codecs_[codec]; }

    // Reports the selected codec's result, in times of one thread. The receiver reports decoding later, or never; then
    // it counts as equal to encoding.
    void encoded(const TileClass& tile, size_t codec, uint64_t rawBytes, uint64_t encodedBytes, int64_t encodeNs);
    void decoded(const TileClass& tile, size_t codec, uint64_t rawBytes, int64_t decodeNs);
    // Reports the measured codec's result for the piece of the last encoded() call.
    void measured(const TileClass& tile, size_t codec, uint64_t rawBytes, uint64_t encodedBytes, int64_t encodeNs,
                  int64_t decodeNs);
    // Reports a transfer during which the link was never idle.
    void transferred(uint64_t bytes, int64_t ns);

    [[nodiscard]] double linkBytesPerSec() const { return linkBytesPerSec_; }
    // Returns the current selection, and the estimated times; 0 ns: unknown.
    [[nodiscard]] size_t best(const TileClass& tile) const;
    [[nodiscard]] double expectedNsPerByte(const TileClass& tile, size_t codec) const;

private:
    struct Estimate {
        double encodeNsPerByte = 0;
        double decodeNsPerByte = 0;
        double encodedPerByte = 1;
        double recentPerByte = 1; // over the last few pieces
        uint64_t reports = 0;
        bool decodeKnown = false;
        bool stale = true;       // not measured since the content changed
        uint64_t measuredAt = 0; // index of the piece within its class
    };
    struct ClassState {
        std::vector<Estimate> codecs;
        uint64_t pieces = 0;
        uint64_t changedAt = 0; // last change of content
        double spentNs = 0;     // estimated cost of recent pieces
        double measuringNs = 0; // cost of measurements
        size_t used = 0;        // codec and result of the last piece
        double usedPerByte = 1;
        double usedEncodeNs = 0; // per byte
    };

    ClassState& stateOf(const TileClass& tile);
    [[nodiscard]] double nsPerByte(const Estimate& e) const;
    [[nodiscard]] size_t bestOf(const ClassState& s) const;
    [[nodiscard]] double totalNsPerByte(double encode, double transfer, double decode) const;
    [[nodiscard]] bool isHopeless(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const;
    struct Times {
        double encode = 0, decode = 0; // in ns per byte
        [[nodiscard]] double sum() const { return encode + decode; }
    };
    [[nodiscard]] Times timesOf(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const;
    [[nodiscard]] double measuringNsPerByte(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const;
    [[nodiscard]] double worthMeasuring(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const;
    [[nodiscard]] std::optional<size_t> toMeasure(PlaneFormat format, const ClassState& s, size_t best,
                                                  uint64_t rawBytes) const;
    void noticeChange(ClassState& s, Estimate& e);

    std::vector<std::string> codecs_;
    SelectorOptions options_;
    size_t raw_ = 0;
    double linkBytesPerSec_;
    uint64_t linkReports_ = 0;
    double lastLinkRate_ = 0; // previous report, if it was an outlier
    std::map<TileClass, ClassState> classes_;
};

} // namespace mural::compositor
