// Chooses, for one link, the codec that gets a piece of a picture across in the least time. All it knows is what it is told
// of pieces before: it has no clock and no thread, and the same reports give the same choices.
//
// Time of a piece: encoding, its bytes over the link, decoding. Each is estimated per class of pieces and codec. The others
// than the best codec are measured on the side: on a piece in a few, one of them encodes and decodes it too, and nothing of
// that is sent. Both outcomes of one piece are compared, so it does not matter that pieces differ.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
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
    double measureShare = 0.01;      // of the time of pieces, for measuring others on the side
    double startBytesPerSec = 125e6; // of the link, until it is measured
};

class CodecSelector {
public:
    // Names; one of them is "raw", which wins wherever no codec is worth its time. Only lossless ones belong here
    // (CodecRegistry::losslessFor), unless the user named others. They are tried in this order.
    explicit CodecSelector(std::vector<std::string> codecs, SelectorOptions options = {});

    // Indices of codecs: the one to use for the next piece of this class, and perhaps one to measure on it.
    struct Choice {
        size_t codec = 0;
        std::optional<size_t> measure;
    };
    [[nodiscard]] Choice choose(const TileClass& tile, uint64_t rawBytes);
    [[nodiscard]] const std::string& name(size_t codec) const { return codecs_[codec]; }

    // What came of the codec that was used. Times are those of one thread. Decoding is told when the receiver's answer comes,
    // or never, and is then taken to last as long as encoding.
    void encoded(const TileClass& tile, size_t codec, uint64_t rawBytes, uint64_t encodedBytes, int64_t encodeNs);
    void decoded(const TileClass& tile, size_t codec, uint64_t rawBytes, int64_t decodeNs);
    // What came of the one that was to be measured, on the piece that encoded() has told of last. Decoding may have been
    // measured here.
    void measured(const TileClass& tile, size_t codec, uint64_t rawBytes, uint64_t encodedBytes, int64_t encodeNs, int64_t decodeNs);
    // The link carried so much in a time in which it was never idle.
    void transferred(uint64_t bytes, int64_t ns);

    [[nodiscard]] double linkBytesPerSec() const { return linkBytesPerSec_; }
    // What would be used now, and how long a codec is thought to take; 0 ns: nothing is known.
    [[nodiscard]] size_t best(const TileClass& tile) const;
    [[nodiscard]] double expectedNsPerByte(const TileClass& tile, size_t codec) const;

private:
    struct Estimate {
        double encodeNsPerByte = 0;
        double decodeNsPerByte = 0;
        double encodedPerByte = 1;
        double recentPerByte = 1; // of the last few pieces
        uint64_t reports = 0;
        bool decodeKnown = false;
        bool stale = true; // not measured since the content changed
        uint64_t measuredAt = 0; // in pieces of the class
    };
    struct ClassState {
        std::vector<Estimate> codecs;
        uint64_t pieces = 0;
        uint64_t changedAt = 0; // when the content became another
        double spentNs = 0;     // what the last pieces took, as estimated
        double measuringNs = 0; // what measuring others took
        size_t used = 0;        // by the last piece, and what it became
        double usedPerByte = 1;
        double usedEncodeNs = 0; // per byte
    };

    ClassState& stateOf(const TileClass& tile);
    [[nodiscard]] double nsPerByte(const Estimate& e) const;
    [[nodiscard]] size_t bestOf(const ClassState& s) const;
    [[nodiscard]] double totalNsPerByte(double encode, double transfer, double decode) const;
    [[nodiscard]] bool isHopeless(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const;
    struct Times {
        double encode = 0, decode = 0; // ns per byte
        [[nodiscard]] double sum() const { return encode + decode; }
    };
    [[nodiscard]] Times timesOf(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const;
    [[nodiscard]] double measuringNsPerByte(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const;
    [[nodiscard]] double worthMeasuring(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const;
    [[nodiscard]] std::optional<size_t> toMeasure(PlaneFormat format, const ClassState& s, size_t best, uint64_t rawBytes) const;
    void noticeChange(ClassState& s, Estimate& e);

    std::vector<std::string> codecs_;
    SelectorOptions options_;
    size_t raw_ = 0;
    double linkBytesPerSec_;
    uint64_t linkReports_ = 0;
    double lastLinkRate_ = 0; // of the report before, when that was far off
    std::map<TileClass, ClassState> classes_;
};

} // namespace mural::compositor
