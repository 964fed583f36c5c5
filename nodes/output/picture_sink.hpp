// A sink of finished pictures: a folder, a video or a window. Owned and called by one thread.
#pragma once

#include <cstdint>
#include <string>

#include "common/base/result.hpp"
#include "nodes/output/eye_pair.hpp"
#include "nodes/output/picture.hpp"

namespace mural {

class PictureSink {
public:
    PictureSink() = default;
    PictureSink(const PictureSink&) = delete;
    PictureSink& operator=(const PictureSink&) = delete;
    // Ends the output as finish() does, but drops the error.
    virtual ~PictureSink() = default;

    // Shows the picture. Its memory can be reused on return.
    virtual Result<void> show(int64_t frame, const Picture& picture) = 0;

    // Returns false if show() and showPair() take Bgra8 only.
    [[nodiscard]] virtual bool takesDeepPictures() const { return false; }

    // Shows one picture per eye. The default shows both side by side.
    virtual Result<void> showPair(int64_t frame, const EyePair& eyes) {
        sideBySide(eyes, bothEyes_);
        return show(frame, bothEyes_.view());
    }

    // Completes open files. Further calls do nothing.
    virtual Result<void> finish() = 0;

    // Returns true if the last show() failed only because a display did not answer in time. The same picture may be
    // shown again.
    [[nodiscard]] virtual bool isBlocked() const { return false; }

    [[nodiscard]] virtual std::string describe() const = 0;

private:
    OwnedPicture bothEyes_;
};

} // namespace mural
