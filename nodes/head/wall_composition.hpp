// How the pictures that nodes draw become the one of the wall: by destinations, each a part of it with eyes, pixels of
// a kernel and samples of its own.
#pragma once

#include <vector>

#include "common/viewport.hpp"
#include "nodes/output/picture.hpp"
#include "nodes/session/render_pass.hpp"

namespace mural {

// Of an anaglyph: which of its colours an eye gives. Alpha is the last one's.
struct EyeColours {
    bool red = true, green = true, blue = true;
    friend bool operator==(const EyeColours&, const EyeColours&) = default;
};

struct WallPart {
    std::string name;
    Viewport area;       // of the wall
    Eye eye = Eye::Cyclop;
    EyeColours colours; // where eyes come together by colour
    PassCounts counts;   // stereo is off: of one eye
    int firstPicture = 0; // its pictures follow each other, in the order of pictureOf()
};

struct WallComposition {
    std::vector<WallPart> parts;
    StereoMode stereo = StereoMode::Off; // how the eyes come together, where there are two
};

// A session without a configuration file: one destination, the whole wall.
WallComposition compositionOf(const PassCounts& counts);

[[nodiscard]] int picturesOf(const WallComposition& wall);

// Pictures of the wall's size (or of every nth pixel of it), of which the parts count. An empty picture leaves its part black. StereoMode::Quad: both eyes, one
// above the other (stackEyes), the same one twice where there are no two.
void composeWall(const WallComposition& wall, const std::vector<Picture>& pictures, OwnedPicture& into);

// The same for a session that compositionOf() describes.
inline void composePasses(const PassCounts& counts, const std::vector<Picture>& pictures, OwnedPicture& into) { composeWall(compositionOf(counts), pictures, into); }

} // namespace mural
