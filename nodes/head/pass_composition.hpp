// The picture of a frame from the pictures of its passes (nodes/session/render_pass.hpp).
#pragma once

#include <vector>

#include "nodes/output/picture.hpp"
#include "nodes/session/render_pass.hpp"

namespace mural {

// `passes` in the order of pictureOf(), as many as picturesOf() says. Samples are averaged in whole numbers and
// rounded once; kernels are interleaved; eyes are put together last. Empty pictures give an empty one.
void composePasses(const PassCounts& counts, const std::vector<Picture>& passes, OwnedPicture& into);

} // namespace mural
