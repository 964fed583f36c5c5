// Registry of codecs by name: built-in ones, and plug-ins from a folder.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "compositor/codecs/codec.hpp"

namespace mural::compositor {

class CodecRegistry {
public:
    // Built-in codecs:
    //   raw                              uncompressed rows
    //   rle64, rle-components, rle-swizzled   run lengths, for comparisons
    //   bitplane, slope                  bit planes; predicted from above, or by linear extrapolation (depth)
    //   bitplane-zstd, slope-zstd        the same, then Zstandard
    //   lz4, zstd                        compressed rows
    //   yuv420, jpeg-N (N: 1 to 100)     lossy; RGBA8 only
    // pluginFolder: search path for other names; empty: none.
    explicit CodecRegistry(std::string pluginFolder = {});

    // Returns the codecs without a number in their name, and opened plug-ins.
    [[nodiscard]] const std::vector<CodecInfo>& known() const { return known_; }
    // Errors: unknown name, or the codec cannot be created.
    [[nodiscard]] Result<CodecInfo> find(const std::string& name);
    [[nodiscard]] Result<std::unique_ptr<Codec>> make(const std::string& name);
    // Returns the candidates of automatic selection: lossless codecs for this format.
    [[nodiscard]] std::vector<CodecInfo> losslessFor(PlaneFormat format) const;

private:
    using Maker = std::function<Result<std::unique_ptr<Codec>>()>;
    void add(CodecInfo info, Maker maker);
    [[nodiscard]] const Maker* makerOf(const std::string& name) const;
    Result<void> open(const std::string& name);

    std::string pluginFolder_;
    std::vector<CodecInfo> known_;
    std::vector<Maker> makers_; // parallel to known_
};

} // namespace mural::compositor
