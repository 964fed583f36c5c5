// Where finished pictures go: a folder, a video, a window. Owned and called by one thread.
#pragma once

#include <cstdint>
#include <string>

#include "common/result.hpp"
#include "nodes/output/eye_pair.hpp"
#include "nodes/output/picture.hpp"

namespace mural {

class PictureSink {
public:
    PictureSink() = default;
    PictureSink(const PictureSink&) = delete;
    PictureSink& operator=(const PictureSink&) = delete;
    // Ends the output as finish() does, but without telling what went wrong.
    virtual ~PictureSink() = default;

    // Takes the picture; its memory is the caller's again on return.
    virtual Result<void> show(int64_t frame, const Picture& picture) = 0;

    // Returns false if show() and showPair() take Bgra8 only.
    [[nodiscard]] virtual bool takesDeepPictures() const { return false; }

    // The same with one for each eye; who has no room for two shows them side by side.
    virtual Result<void> showPair(int64_t frame, const EyePair& eyes) {
        sideBySide(eyes, bothEyes_);
        return show(frame, bothEyes_.view());
    }

    // Nothing more comes: completes what is open. Further calls do nothing.
    virtual Result<void> finish() = 0;

    // The last show() failed only because a display has not answered in time: the same picture may be shown again.
    [[nodiscard]] virtual bool isBlocked() const { return false; }

    [[nodiscard]] virtual std::string describe() const = 0;

private:
    OwnedPicture bothEyes_;
};

} // namespace mural
