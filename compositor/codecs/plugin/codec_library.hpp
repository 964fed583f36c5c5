// Finding and opening the plug-in of a codec (codec_plugin.h).
#pragma once

#include <memory>
#include <string>

#include "compositor/codecs/codec.hpp"
#include "compositor/codecs/plugin/codec_plugin.h"

namespace mural::compositor {

// Opens FOLDER/libmural_codec_NAME.so; it stays open. Errors: it is not there or can't be loaded, is no plug-in, is one of
// another version or name.
[[nodiscard]] Result<const mural_codec_plugin*> openCodecPlugin(const std::string& name, const std::string& folder);
[[nodiscard]] CodecInfo infoOf(const mural_codec_plugin& plugin);
[[nodiscard]] Result<std::unique_ptr<Codec>> makeCodec(const mural_codec_plugin& plugin);

} // namespace mural::compositor
