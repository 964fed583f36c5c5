// Pictures for the report.
#pragma once

#include <string>

#include "nodes/launch/private_display.hpp"
#include "nodes/output/picture.hpp"

namespace mural::cli {

// Writes the largest visible window of a private display into a PNG file. Returns false if there is none, or if the
// display does not answer within some seconds, such as during a grab.
bool saveLargestWindow(const launch::PrivateDisplay& display, const std::string& file);

// Returns a picture that is at most maxWidth wide: each pixel is the mean of the pixels that it replaces.
OwnedPicture reduced(const Picture& picture, int maxWidth);

} // namespace mural::cli
