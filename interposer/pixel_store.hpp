// The pixel-store state of the program's context, asked from the context itself: it is needed only
// where images travel, and asking is always right (client attribute stacks, other entry points).
#pragma once

#include "streamcodec/sizes/pixel_format.hpp"

namespace mural {

struct Context;

[[nodiscard]] bool unpackBufferBound(const Context& c);
[[nodiscard]] bool packBufferBound(const Context& c);
[[nodiscard]] sizes::PixelStore unpackStore(const Context& c);
[[nodiscard]] sizes::PixelStore packStore(const Context& c);
// True when the image lies in client memory just as it travels.
[[nodiscard]] bool isTight(const sizes::ImageLayout& layout);

} // namespace mural
