#include "streamcodec/delta/entropy/section_codec.hpp"

#include <algorithm>
#include <cstring>
#include <lz4.h>
#include <zstd.h>

#include "common/base/copy_bytes.hpp"

namespace mural::delta {

namespace {

constexpr int kZstdWindowLog = 20;                 // 1 MiB, per section and side
constexpr size_t kMaxRoomBytes = size_t{32} << 10; // output growth step; new room is zero-filled first
constexpr size_t kLz4Window = 65536;
constexpr size_t kLz4PieceBytes = size_t{128} << 10; // of a section

// The last bytes for LZ4, contiguous as it requires. They move to the front only when the room is full: moving takes as
// long as compressing a short frame.
class Lz4Window {
public:
    static constexpr size_t kRoomBytes = kLz4Window + 2 * kLz4PieceBytes;

    [[nodiscard]] std::span<const std::byte> last() const {
        return {room_.get() + end_ - std::min(end_, kLz4Window), std::min(end_, kLz4Window)};
    }
    // Returns room for a piece after the existing bytes. move(to, last()) must copy those bytes, which may overlap.
    template <typename Move> std::span<std::byte> add(size_t sizeBytes, Move&& move) {
        if (!room_) room_ = std::make_unique_for_overwrite<std::byte[]>(kRoomBytes);
        if (sizeBytes > kRoomBytes - end_) {
            const auto window = last();
            move(room_.get(), window);
            end_ = window.size();
        }
        end_ += sizeBytes;
        return {room_.get() + end_ - sizeBytes, sizeBytes};
    }

private:
    std::unique_ptr<std::byte[]> room_{}; // committed on first use
    size_t end_ = 0;
};

char* chars(std::byte* bytes) { return reinterpret_cast<char*>(bytes); }
const char* chars(const std::byte* bytes) { return reinterpret_cast<const char*>(bytes); }

void putSize(std::vector<std::byte>& into, uint32_t size) {
    const auto* p = reinterpret_cast<const std::byte*>(&size);
    into.insert(into.end(), p, p + sizeof size);
}

} // namespace

size_t lz4Bytes(std::span<const std::byte> bytes, std::vector<std::byte>& scratch) {
    const int size = static_cast<int>(bytes.size()), room = LZ4_compressBound(size);
    scratch.resize(static_cast<size_t>(room));
    return static_cast<size_t>(LZ4_compress_default(chars(bytes.data()), chars(scratch.data()), size, room));
}

struct SectionCompressor::State {
    const int zstdLevel;
    std::unique_ptr<ZSTD_CCtx, size_t (*)(ZSTD_CCtx*)> zstd{nullptr, ZSTD_freeCCtx};
    std::unique_ptr<LZ4_stream_t, int (*)(LZ4_stream_t*)> lz4{nullptr, LZ4_freeStream};
    Lz4Window window{};
    std::unique_ptr<std::byte[]> packed{}; // output of LZ4

    bool openZstd() {
        if (zstd) return true;
        zstd.reset(ZSTD_createCCtx());
        if (!zstd) return false;
        ZSTD_CCtx_setParameter(zstd.get(), ZSTD_c_compressionLevel, zstdLevel);
        ZSTD_CCtx_setParameter(zstd.get(), ZSTD_c_windowLog, kZstdWindowLog);
        ZSTD_CCtx_setParameter(zstd.get(), ZSTD_c_contentSizeFlag, 0);
        return true;
    }
    bool byZstd(std::span<const std::byte> bytes, std::vector<std::byte>& into) {
        if (!openZstd()) return false;
        ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
        size_t left = 1;
        const size_t room = std::min(ZSTD_compressBound(bytes.size()) + 64, kMaxRoomBytes);
        while (left != 0) {
            const size_t before = into.size();
            into.resize(before + room);
            ZSTD_outBuffer out{into.data() + before, room, 0};
            left = ZSTD_compressStream2(zstd.get(), &out, &in, ZSTD_e_flush);
            into.resize(before + out.pos);
            if (ZSTD_isError(left)) return false;
        }
        return true;
    }

    bool byLz4(std::span<const std::byte> bytes, std::vector<std::byte>& into) {
        constexpr int kRoom = LZ4_COMPRESSBOUND(kLz4PieceBytes);
        if (!lz4) {
            lz4.reset(LZ4_createStream());
            if (!lz4) return false;
            packed = std::make_unique_for_overwrite<std::byte[]>(kRoom);
        }
        while (!bytes.empty()) {
            const auto piece = bytes.first(std::min(bytes.size(), kLz4PieceBytes));
            bytes = bytes.subspan(piece.size());
            // LZ4 uses its whole window only for input that follows it in memory.
            const auto copy = window.add(piece.size(), [&](std::byte* to, std::span<const std::byte> last) {
                LZ4_saveDict(lz4.get(), chars(to), static_cast<int>(last.size()));
            });
            copyBytes(piece, copy);
            const int size = LZ4_compress_fast_continue(lz4.get(), chars(copy.data()), chars(packed.get()),
                                                        static_cast<int>(copy.size()), kRoom, 1);
            if (size <= 0) return false;
            putSize(into, static_cast<uint32_t>(size));
            into.insert(into.end(), packed.get(), packed.get() + size);
        }
        return true;
    }
};

SectionCompressor::SectionCompressor(int zstdLevel) : state_(new State{zstdLevel}) {}
SectionCompressor::~SectionCompressor() = default;
SectionCompressor::SectionCompressor(SectionCompressor&&) noexcept = default;

bool SectionCompressor::compress(Coding coding, std::span<const std::byte> bytes, std::vector<std::byte>& into) {
    return coding == Coding::Zstd ? state_->byZstd(bytes, into) : state_->byLz4(bytes, into);
}

void SectionCompressor::prepare() {
    const std::vector<std::byte> nothing(size_t{128} << 10); // one Zstandard block
    std::vector<std::byte> into;
    for (size_t filled = 0; filled <= size_t{1} << kZstdWindowLog; filled += nothing.size())
        if (!state_->byZstd(nothing, into)) return;
    ZSTD_CCtx_reset(state_->zstd.get(), ZSTD_reset_session_only);
    (void)state_->byZstd({}, into); // clears its tables before the first frame, without output
}

struct SectionDecompressor::State {
    std::unique_ptr<ZSTD_DCtx, size_t (*)(ZSTD_DCtx*)> zstd{nullptr, ZSTD_freeDCtx};
    Lz4Window window;

    bool byZstd(std::span<const std::byte> bytes, std::span<std::byte> into) {
        if (!zstd) {
            zstd.reset(ZSTD_createDCtx());
            if (!zstd) return false;
            // bounds the memory for malformed input
            ZSTD_DCtx_setParameter(zstd.get(), ZSTD_d_windowLogMax, kZstdWindowLog);
        }
        ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
        ZSTD_outBuffer out{into.data(), into.size(), 0};
        while (in.pos < in.size || out.pos < out.size) {
            const size_t inBefore = in.pos, outBefore = out.pos;
            if (ZSTD_isError(ZSTD_decompressStream(zstd.get(), &out, &in))) return false;
            if (in.pos == inBefore && out.pos == outBefore) return false; // truncated input
        }
        std::byte more{};
        ZSTD_outBuffer behind{&more, 1, 0};
        return !ZSTD_isError(ZSTD_decompressStream(zstd.get(), &behind, &in)) && behind.pos == 0;
    }

    bool byLz4(std::span<const std::byte> bytes, std::span<std::byte> into) {
        while (!into.empty()) {
            uint32_t size = 0;
            if (bytes.size() < 4) return false;
            std::memcpy(&size, bytes.data(), 4);
            bytes = bytes.subspan(4);
            const auto piece = into.first(std::min(into.size(), kLz4PieceBytes));
            if (size > bytes.size()) return false;
            const auto last = window.last();
            const int got = LZ4_decompress_safe_usingDict(chars(bytes.data()), chars(piece.data()),
                                                          static_cast<int>(size), static_cast<int>(piece.size()),
                                                          chars(last.data()), static_cast<int>(last.size()));
            if (got < 0 || static_cast<size_t>(got) != piece.size()) return false;
            copyBytes(piece, window.add(piece.size(), [](std::byte* to, std::span<const std::byte> kept) {
                std::memmove(to, kept.data(), kept.size());
            }));
            bytes = bytes.subspan(size);
            into = into.subspan(piece.size());
        }
        return bytes.empty();
    }
};

SectionDecompressor::SectionDecompressor() : state_(std::make_unique<State>()) {}
SectionDecompressor::~SectionDecompressor() = default;
SectionDecompressor::SectionDecompressor(SectionDecompressor&&) noexcept = default;

bool SectionDecompressor::decompress(Coding coding, std::span<const std::byte> bytes, std::span<std::byte> into) {
    return coding == Coding::Zstd ? state_->byZstd(bytes, into) : state_->byLz4(bytes, into);
}

} // namespace mural::delta
