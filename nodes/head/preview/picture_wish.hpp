// Messages between the head and a page about pictures of the wall, on the socket `pictures` of the session. Both are
// processes of one user on one machine.
//
// A page sends a PictureWish and waits for its PictureNotice. The first wish, and each one after NeedsMemory, carries
// the descriptor of shared memory (SCM_RIGHTS) to which the head writes the picture: rows of BGRA, the lowest row
// first. The memory is sealed against shrinking (F_SEAL_SHRINK), so no page can make the head access pages that are
// gone.
#pragma once

#include <cstdint>

namespace mural {

inline constexpr uint32_t kPictureWishVersion = 1;
inline constexpr uint32_t kWallPicture = 0; // `source` of the whole wall; 1 + N: the part of node N

struct PictureWish {
    uint32_t version = kPictureWishVersion;
    uint32_t source = kWallPicture;
    uint32_t maxWidth = 0, maxHeight = 0; // the picture is reduced to these sizes
    uint64_t afterFrame = 0;              // the picture must be of a later frame of the wall
};

enum class PictureOutcome : uint32_t {
    Written,
    NeedsMemory, // `bytes` of shared memory are required
    NoSuchSource // the head has no pictures of it
};

struct PictureNotice {
    PictureOutcome outcome = PictureOutcome::Written;
    uint32_t width = 0, height = 0;             // of the written picture
    uint32_t sourceWidth = 0, sourceHeight = 0; // before the reduction
    uint32_t reserved = 0;
    uint64_t frame = 0; // of the wall
    uint64_t bytes = 0;
};

static_assert(sizeof(PictureWish) == 24 && sizeof(PictureNotice) == 40);

} // namespace mural
