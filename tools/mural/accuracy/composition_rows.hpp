// The loops that put pictures together, on made-up pictures, against what they mean pixel by pixel; and the codecs.
#pragma once

#include "nodes/output/picture.hpp"
#include "tools/mural/accuracy/accuracy_row.hpp"

namespace mural::cli {

void measureComposition(std::vector<AccuracyRow>& rows);

// On pictures of the scenes; none: nothing is measured.
void measureCodecs(const std::vector<OwnedPicture>& pictures, const std::string& group, bool quick, std::vector<AccuracyRow>& rows);

} // namespace mural::cli
