// Encodes a picture as a reply to the program, which shows it in its own window during a server grab
// (capture::OwnWindow).
#pragma once

#include "nodes/head/capture/capture_client.hpp"
#include "nodes/output/picture.hpp"
#include "nodes/output/pixel_format.hpp"

namespace mural {

// Returns the reply with the converted picture. `format` comes from the program and is checked. The reply has no pixels
// if the format is invalid or memory is short.
Reply ownPictureReply(uint32_t frame, uint32_t window, const PixelFormat& format, const Picture& picture);

} // namespace mural
