// Compositing loops on synthetic pictures, compared pixel by pixel with their definitions; and the codecs.
#pragma once

#include "nodes/output/picture.hpp"
#include "tools/mural/accuracy/accuracy_row.hpp"

namespace mural::cli {

void measureComposition(std::vector<AccuracyRow>& rows);

// Measures codecs on pictures of the scenes; without pictures, nothing.
void measureCodecs(const std::vector<OwnedPicture>& pictures, const std::string& group, bool quick, std::vector<AccuracyRow>& rows);

} // namespace mural::cli
