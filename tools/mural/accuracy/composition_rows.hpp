// Measures compositing loops on synthetic pictures against their definitions, pixel by pixel; and the codecs.
#pragma once

#include "nodes/output/picture.hpp"
#include "tools/mural/accuracy/accuracy_row.hpp"

namespace mural::cli {

void measureComposition(std::vector<AccuracyRow>& rows);

// Measures codecs on pictures of the scenes; without pictures, nothing.
void measureCodecs(const std::vector<OwnedPicture>& pictures, const std::string& group, bool quick,
                   std::vector<AccuracyRow>& rows);

} // namespace mural::cli
