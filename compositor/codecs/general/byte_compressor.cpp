#include "compositor/codecs/general/byte_compressor.hpp"

#include <climits>
#include <lz4.h>
#include <zstd.h>

namespace mural::compositor {

namespace {

char* chars(std::byte* bytes) { return reinterpret_cast<char*>(bytes); }
const char* chars(const std::byte* bytes) { return reinterpret_cast<const char*>(bytes); }

class Lz4 : public ByteCompressor {
public:
    [[nodiscard]] size_t boundBytes(size_t sizeBytes) const override {
        return sizeBytes > LZ4_MAX_INPUT_SIZE ? 0 : static_cast<size_t>(LZ4_compressBound(static_cast<int>(sizeBytes)));
    }
    [[nodiscard]] size_t compress(std::span<const std::byte> bytes, std::span<std::byte> into) override {
        if (bytes.size() > LZ4_MAX_INPUT_SIZE || into.size() > INT_MAX) return 0;
        return static_cast<size_t>(LZ4_compress_default(chars(bytes.data()), chars(into.data()),
                                                        static_cast<int>(bytes.size()), static_cast<int>(into.size())));
    }
    [[nodiscard]] bool decompress(std::span<const std::byte> bytes, std::span<std::byte> into) override {
        if (bytes.size() > INT_MAX || into.size() > LZ4_MAX_INPUT_SIZE) return false;
        const int size = LZ4_decompress_safe(chars(bytes.data()), chars(into.data()), static_cast<int>(bytes.size()),
                                             static_cast<int>(into.size()));
        return size >= 0 && static_cast<size_t>(size) == into.size();
    }
};

class Zstd : public ByteCompressor {
public:
    explicit Zstd(int level)
        : level_(level),
          compressor_(ZSTD_createCCtx(), ZSTD_freeCCtx),
          decompressor_(ZSTD_createDCtx(), ZSTD_freeDCtx) {}
    [[nodiscard]] size_t boundBytes(size_t sizeBytes) const override { return ZSTD_compressBound(sizeBytes); }
    [[nodiscard]] size_t compress(std::span<const std::byte> bytes, std::span<std::byte> into) override {
        if (!compressor_) return 0;
        const size_t size =
            ZSTD_compressCCtx(compressor_.get(), into.data(), into.size(), bytes.data(), bytes.size(), level_);
        return ZSTD_isError(size) ? 0 : size;
    }
    [[nodiscard]] bool decompress(std::span<const std::byte> bytes, std::span<std::byte> into) override {
        if (!decompressor_) return false;
        const size_t size =
            ZSTD_decompressDCtx(decompressor_.get(), into.data(), into.size(), bytes.data(), bytes.size());
        return !ZSTD_isError(size) && size == into.size();
    }

private:
    int level_;
    std::unique_ptr<ZSTD_CCtx, size_t (*)(ZSTD_CCtx*)> compressor_;
    std::unique_ptr<ZSTD_DCtx, size_t (*)(ZSTD_DCtx*)> decompressor_;
};

} // namespace

std::unique_ptr<ByteCompressor> makeLz4() { return std::make_unique<Lz4>(); }
std::unique_ptr<ByteCompressor> makeZstd(int level) { return std::make_unique<Zstd>(level); }

} // namespace mural::compositor
