// Finds and opens the plug-in of a codec (codec_plugin.h).
#pragma once

#include <memory>
#include <string>

#include "compositor/codecs/codec.hpp"
#include "compositor/codecs/plugin/codec_plugin.h"

namespace mural::compositor {

// Opens FOLDER/libmural_codec_NAME.so, which stays open. Errors: missing or not loadable, not a plug-in, another
// version or name.
[[nodiscard]] Result<const mural_codec_plugin*> openCodecPlugin(const std::string& name, const std::string& folder);
[[nodiscard]] CodecInfo infoOf(const mural_codec_plugin& plugin);
[[nodiscard]] Result<std::unique_ptr<Codec>> makeCodec(const mural_codec_plugin& plugin);

} // namespace mural::compositor
