// Composes the wall from the pictures of the nodes. Each destination is a part of the wall with its own eyes, kernel
// pixels and samples.
#pragma once

#include <vector>

#include "common/geometry/viewport.hpp"
#include "nodes/output/picture.hpp"
#include "nodes/session/render_pass.hpp"

namespace mural {

// The colour channels that an eye contributes to an anaglyph. The last eye sets alpha.
struct EyeColours {
    bool red = true, green = true, blue = true;
    friend bool operator==(const EyeColours&, const EyeColours&) = default;
};

struct WallPart {
    std::string name;
    Viewport area; // on the wall
    Eye eye = Eye::Cyclop;
    EyeColours colours;   // for anaglyph stereo
    PassCounts counts;    // per eye: stereo is off
    int firstPicture = 0; // its pictures are consecutive, in the order of pictureOf()
};

// A part of a canvas that shows a part of a canvas again, scaled: a picture on a monitor.
struct PictureCopy {
    int canvas = 0; // the source: 0 is the first canvas, n is SessionPlan::canvases[n - 1]
    Viewport from;  // on the source
    Viewport to;    // on this canvas
};

struct WallComposition {
    std::vector<WallPart> parts;
    std::vector<PictureCopy> copies;     // over the parts
    StereoMode stereo = StereoMode::Off; // how two eyes are combined
};

// Returns the composition of a session without a configuration file: one destination, the whole wall.
WallComposition compositionOf(const PassCounts& counts);

[[nodiscard]] int picturesOf(const WallComposition& wall);

// pictures: in the size of the wall, or every nth pixel of it; only the parts' areas count. An empty picture leaves its
// part black. Ignores copies. StereoMode::Quad stacks both eyes (stackEyes); a single eye appears twice.
void composeWall(const WallComposition& wall, const std::vector<Picture>& pictures, OwnedPicture& into);

// The same for a session that compositionOf() describes.
inline void composePasses(const PassCounts& counts, const std::vector<Picture>& pictures, OwnedPicture& into) {
    composeWall(compositionOf(counts), pictures, into);
}

} // namespace mural
