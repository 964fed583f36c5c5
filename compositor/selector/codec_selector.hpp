// Chooses, for one link, the codec that gets a piece of a picture across in the least time. All it knows is what it is told
// of pieces before: it has no clock and no thread, and the same reports give the same choices.
//
// Time of a piece: encoding, its bytes over the link, decoding. Each is measured per class of pieces and codec; a codec that
// was not measured yet, or not since the content changed, is tried on one piece in a few.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "compositor/selector/tile_class.hpp"

namespace mural::compositor {

// What of a piece's three times counts.
enum class Overlap : uint8_t {
    Serial,    // their sum: nothing else is to be done meanwhile, latency counts
    Pipelined, // the longest: other pieces are encoded, carried and decoded meanwhile
};

struct SelectorOptions {
    Overlap overlap = Overlap::Pipelined;
    // Parts of the time that trying others may cost, once all were measured.
    double exploreShare = 0.02;
    double startBytesPerSec = 125e6; // of the link, until it is measured
};

class CodecSelector {
public:
    // Names; one of them is "raw", which wins wherever no codec is worth its time. Only lossless ones belong here
    // (CodecRegistry::losslessFor), unless the user named others. They are tried in this order.
    explicit CodecSelector(std::vector<std::string> codecs, SelectorOptions options = {});

    // The index of the codec to use for the next piece of this class.
    [[nodiscard]] size_t choose(const TileClass& tile, uint64_t rawBytes);
    [[nodiscard]] const std::string& name(size_t codec) const { return codecs_[codec]; }

    // What came of it. Times are CPU or wall time of one piece; decoding is told when the receiver's answer comes, or never,
    // and is then taken to last as long as encoding.
    void encoded(const TileClass& tile, size_t codec, uint64_t rawBytes, uint64_t encodedBytes, int64_t encodeNs);
    void decoded(const TileClass& tile, size_t codec, uint64_t rawBytes, int64_t decodeNs);
    // The link carried so much in a time in which it was never idle.
    void transferred(uint64_t bytes, int64_t ns);

    [[nodiscard]] double linkBytesPerSec() const { return linkBytesPerSec_; }
    // As it would be chosen now, without trying others; and how long it is thought to take. 0 ns: nothing is known.
    [[nodiscard]] size_t best(const TileClass& tile) const;
    [[nodiscard]] double expectedNsPerByte(const TileClass& tile, size_t codec) const;

private:
    struct Estimate {
        double encodeNsPerByte = 0;
        double decodeNsPerByte = 0;
        double encodedPerByte = 1;
        uint64_t reports = 0;
        bool decodeKnown = false;
        bool stale = true; // not measured since the content changed
        uint64_t measuredAt = 0; // in pieces of the class
    };
    struct ClassState {
        std::vector<Estimate> codecs;
        uint64_t pieces = 0;
        double spentNs = 0;    // what the last pieces took, as estimated
        double exploredNs = 0; // what of that trying others cost
        size_t chosen = 0;
    };

    ClassState& stateOf(const TileClass& tile);
    [[nodiscard]] double nsPerByte(const Estimate& e) const;
    [[nodiscard]] size_t bestOf(const ClassState& s) const;
    [[nodiscard]] size_t toTry(const ClassState& s, size_t best, uint64_t rawBytes) const;

    std::vector<std::string> codecs_;
    SelectorOptions options_;
    size_t raw_ = 0;
    double linkBytesPerSec_;
    uint64_t linkReports_ = 0;
    double lastLinkRate_ = 0; // of the report before, when that was far off
    std::map<TileClass, ClassState> classes_;
};

} // namespace mural::compositor
