// The codecs that there are, by name: Mural's own, and plug-ins from a folder.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "compositor/codecs/codec.hpp"

namespace mural::compositor {

class CodecRegistry {
public:
    // Mural's own:
    //   raw                              the rows as they are
    //   rle64, rle-components, rle-swizzled   run lengths, to be measured against
    //   bitplane, slope                  bit planes; predicted from above, or with the slope of a surface of depth
    //   bitplane-zstd, slope-zstd        the same, then Zstandard
    //   lz4, zstd                        the rows as bytes
    //   yuv420, jpeg-N (N: 1 to 100)     lossy; RGBA8 only
    // pluginFolder: where make looks for a name that is none of them; empty: nowhere.
    explicit CodecRegistry(std::string pluginFolder = {});

    // Those without a number in their name, and plug-ins that were asked for.
    [[nodiscard]] const std::vector<CodecInfo>& known() const { return known_; }
    // Errors: there is none of this name, or it can't be made.
    [[nodiscard]] Result<CodecInfo> find(const std::string& name);
    [[nodiscard]] Result<std::unique_ptr<Codec>> make(const std::string& name);
    // What a selector may choose from by itself: lossless, and for this format.
    [[nodiscard]] std::vector<CodecInfo> losslessFor(PlaneFormat format) const;

private:
    using Maker = std::function<Result<std::unique_ptr<Codec>>()>;
    void add(CodecInfo info, Maker maker);
    [[nodiscard]] const Maker* makerOf(const std::string& name) const;
    Result<void> open(const std::string& name);

    std::string pluginFolder_;
    std::vector<CodecInfo> known_;
    std::vector<Maker> makers_; // as known_
};

} // namespace mural::compositor
