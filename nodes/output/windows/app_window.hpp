// Shows pictures in a window that belongs to another X client: the program's own window. Pixels keep alpha and all bits
// per channel of the window's visual.
//
// Pixels are put 1:1, aligned at the upper left corners and clipped to the window. Child windows stay on top, as with
// OpenGL. A window that is gone, unmapped or of another size is not an error. Used by one thread.
//
// X reuses window ids: the windows of the next program often have the ids of an ended one. The window's owner is
// therefore checked before each picture. X has no request that draws only if the owner is still the same. No wait of
// this process lies between the check and the picture. A wrong window is possible only if, within that moment, the
// window ends, its client disconnects, and another client connects and creates a window.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nodes/output/picture_sink.hpp"
#include "nodes/output/pixel_format.hpp"
#include "nodes/output/windows/shared_pixels.hpp"
#include "nodes/output/windows/window_owner.hpp"
#include "nodes/output/windows/x_connection.hpp"

namespace mural {

struct AppWindowConfig {
    std::string displayName;          // empty: DISPLAY
    uint32_t window = 0;              // XID
    std::optional<WindowOwner> owner; // pictures are painted only in a window of this program
    int64_t timeoutMs = 5'000;        // limit of open() and of each show(); another client may grab the server
    bool sharedMemory = true;         // used if the server supports it
    size_t pieceBytes = 32 * 1024;    // bytes of pixels per request without shared memory
};

class AppWindow : public PictureSink {
public:
    // Errors: no display, or a visual whose pixels can't be written. A missing window is no error, because a program
    // may end right after its last swap: see windowGone(). A display that does not answer in time is no error either:
    // show() connects then.
    static Result<std::unique_ptr<AppWindow>> open(AppWindowConfig config);

    // Returns after the server has drawn the picture. May be called again after a deadline has passed.
    Result<void> show(int64_t frame, const Picture& picture) override;
    [[nodiscard]] bool isBlocked() const override { return isBlocked_; }
    Result<void> finish() override { return {}; } // every picture was complete when show() returned
    [[nodiscard]] bool takesDeepPictures() const override { return true; }
    [[nodiscard]] std::string describe() const override;

    // Returns whether the last picture found no window. The next picture checks again.
    [[nodiscard]] bool windowGone() const { return windowGone_; }
    [[nodiscard]] bool usesSharedMemory() const { return shared_ != nullptr; }

private:
    // A put of pixels that the server has not acknowledged.
    struct Put {
        xcb_void_cookie_t request;
        unsigned fence;
    };
    enum class Outcome { Done, Again };

    explicit AppWindow(AppWindowConfig config) : config_(std::move(config)) {}

    Result<void> connect(Deadline deadline);
    Result<void> showBefore(Deadline deadline, const Picture& picture);
    Error missed(XAnswer answer);
    Result<void> confirmOwner(Deadline deadline);
    Result<void> adopt(Deadline deadline);
    Result<void> findConverter(xcb_visualid_t visual, int depth);
    Result<Outcome> showOnce(const Picture& picture, Deadline deadline);
    bool sharedFor(size_t sizeBytes, Deadline deadline);
    Result<void> putShared(const Picture& picture, int width, int height, Deadline deadline);
    Result<void> putInPieces(const Picture& picture, int width, int height, Deadline deadline);
    void convert(const Picture& picture, const PixelViewport& part, std::byte* target) const;
    void sent(xcb_void_cookie_t request);
    Result<void> settle(size_t keep, Deadline deadline);
    Result<Outcome> judge();

    AppWindowConfig config_;
    std::unique_ptr<XConnection> x_;
    std::optional<WindowOwnerCheck> owner_;
    bool ownerChecked_ = false;               // the owner was checked before an earlier picture was complete
    std::optional<PixelConverter> converter_; // for the window's visual
    xcb_gcontext_t gc_ = 0;                   // 0: none yet
    std::unique_ptr<SharedPixels> shared_;
    bool sharedRefused_ = false;
    std::vector<std::byte> piece_;
    std::deque<Put> unanswered_;
    XOwned<xcb_generic_error_t> firstError_; // first error among the puts of one picture
    bool windowGone_ = false;
    bool isBlocked_ = false;   // state of the last show()
    bool hasAnswered_ = false; // the server has answered since show() began
};

} // namespace mural
