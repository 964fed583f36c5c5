// Compression of the pieces of blobs that readers request. Each piece is coded alone, so pieces may arrive in any
// coding.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/base/clock.hpp"
#include "objects/blob/blob_memory.hpp"

namespace mural::objects {

enum class PieceCoding : uint8_t {
    Raw,
    Zstd,       // Zstandard, level -1
    ZstdPlanes, // the first bytes of all 4-byte words, then the second ones, ...; a rest of up to 3 bytes; Zstandard
};
constexpr size_t kPieceCodings = 3;

struct CodedPiece {
    PieceCoding coding = PieceCoding::Raw;
    std::span<const std::byte> bytes;
    uint32_t codingMicroseconds = 0;
};

// Chooses the coding of each piece by measured time: a piece is compressed where coding, transfer and decoding of the
// coded bytes take less time than the transfer of the raw bytes. The first piece of a blob measures all codings.
//
// Thread safety: none.
class PieceCoder {
public:
    // now: the time in ns, for the measurement.
    explicit PieceCoder(int64_t (*now)() = monotonicNowNs) : now_(now) {}

    // bytesPerSecond: rate of the reader's connection; 0: unknown, and the piece stays raw. The result refers to `raw`,
    // or to memory that is valid until the next call.
    CodedPiece code(const BlobName& blob, std::span<const std::byte> raw, uint64_t bytesPerSecond);

private:
    static constexpr size_t kMostKnown = 256; // blobs with measurements

    struct Measured {
        double nsPerByte = 0, ratio = 1; // of raw bytes; coded / raw
    };
    using OfBlob = std::array<Measured, kPieceCodings>;

    CodedPiece coded(PieceCoding coding, std::span<const std::byte> raw, Measured& measured);
    [[nodiscard]] static PieceCoding fastest(const OfBlob& known, uint64_t bytesPerSecond);

    int64_t (*now_)();
    std::map<BlobName, OfBlob> known_;
    std::vector<std::byte> planes_, coded_;
};

// Returns the raw bytes, which refer to `coded` or `scratch`. Empty: the bytes are damaged, or not of that size.
std::optional<std::span<const std::byte>> decodePiece(PieceCoding coding, std::span<const std::byte> coded,
                                                      size_t rawBytes, std::vector<std::byte>& scratch);

} // namespace mural::objects
