#include "nodes/output/windows/app_window.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "common/log/log.hpp"

namespace mural {

namespace {

constexpr int kLargestWindowSide = 32767; // limit of X windows and coordinates
constexpr uint8_t kBadWindow = 3;
constexpr uint8_t kBadMatch = 8;
constexpr uint8_t kBadDrawable = 9;
constexpr size_t kPutImageHeaderBytes = 24;

const xcb_visualtype_t* findVisual(const xcb_setup_t& setup, xcb_visualid_t id) {
    for (auto screen = xcb_setup_roots_iterator(&setup); screen.rem > 0; xcb_screen_next(&screen))
        for (auto depth = xcb_screen_allowed_depths_iterator(screen.data); depth.rem > 0; xcb_depth_next(&depth))
            for (auto visual = xcb_depth_visuals_iterator(depth.data); visual.rem > 0; xcb_visualtype_next(&visual))
                if (visual.data->visual_id == id) return visual.data;
    return nullptr;
}

const xcb_format_t* findFormat(const xcb_setup_t& setup, int depth) {
    for (auto format = xcb_setup_pixmap_formats_iterator(&setup); format.rem > 0; xcb_format_next(&format))
        if (format.data->depth == depth) return format.data;
    return nullptr;
}

} // namespace

Result<std::unique_ptr<AppWindow>> AppWindow::open(AppWindowConfig config) {
    const Deadline deadline = Deadline::inMs(config.timeoutMs);
    std::unique_ptr<AppWindow> window(new AppWindow(std::move(config)));
    Result<void> ready = window->connect(deadline);
    if (ready) ready = window->adopt(deadline);
    if (!ready && !window->isBlocked()) return ready.error();
    log::debug(log::Topic::Output, "the program's window ", window->config_.window, " on display \"",
               window->config_.displayName, "\"", ready ? "" : " does not answer yet");
    return window;
}

Result<void> AppWindow::connect(Deadline deadline) {
    auto connected = XConnection::open(config_.displayName, deadline);
    if (!connected) {
        isBlocked_ = deadline.passed();
        return connected.error();
    }
    x_ = std::move(connected.value());
    if (config_.owner) owner_.emplace(*config_.owner);
    if (x_->setup().image_byte_order != XCB_IMAGE_ORDER_LSB_FIRST) {
        return Error{fmt::format(
            "the X display '{}' belongs to a big-endian machine, which is not supported; use another display",
            x_->displayName())};
    }
    return {};
}

Result<void> AppWindow::show(int64_t frame, const Picture& picture) {
    if (picture.empty()) return Error{fmt::format("frame {} is empty: nothing to show", frame)};
    const Deadline deadline = Deadline::inMs(config_.timeoutMs);
    isBlocked_ = false;
    hasAnswered_ = false;
    if (x_ == nullptr) {
        if (Result<void> connected = connect(deadline); !connected) return connected;
    }
    return showBefore(deadline, picture);
}

Result<void> AppWindow::showBefore(Deadline deadline, const Picture& picture) {
    // Completes puts of an earlier call whose deadline passed. The server may still read their shared memory.
    if (Result<void> settled = settle(0, deadline); !settled) return settled;
    firstError_.reset();
    // Further attempts follow if shared memory was refused, or if the window's id now belongs to a new window.
    for (int attempt = 0; attempt < 3; ++attempt) {
        if (windowGone_ || !converter_) {
            if (Result<void> adopted = adopt(deadline); !adopted) return adopted;
            if (windowGone_) return {};
        }
        if (Result<void> confirmed = confirmOwner(deadline); !confirmed || windowGone_) return confirmed;
        Result<Outcome> outcome = showOnce(picture, deadline);
        if (!outcome) return outcome.error();
        if (outcome.value() == Outcome::Done) return {};
    }
    return Error{
        fmt::format("the window {:#x} of the X display '{}' accepts no pictures, because it changes all the time",
                    config_.window, x_->displayName())};
}

// Returns the error of a missed deadline. A server that answers, but slowly, is not blocked: another attempt would take
// as long.
Error AppWindow::missed(XAnswer answer) {
    isBlocked_ = answer == XAnswer::TimedOut && !hasAnswered_;
    return x_->describe(answer);
}

std::string AppWindow::describe() const {
    return fmt::format("window {:#x} of the X display {} ({})", config_.window,
                       x_ != nullptr ? x_->displayName() : config_.displayName,
                       shared_ != nullptr ? "shared memory" : "through the connection");
}

// Sets windowGone_ if the window does not exist or is not the program's. Only another owner at the first check is an
// error, because programs end while their last pictures are in transfer.
Result<void> AppWindow::confirmOwner(Deadline deadline) {
    if (!owner_) return {};
    auto owned = owner_->owns(*x_, config_.window, deadline);
    if (!owned) {
        isBlocked_ = deadline.passed() && !hasAnswered_;
        return owned.error();
    }
    windowGone_ = *owned != WindowOwnerCheck::Owned::Yes;
    const bool first = !std::exchange(ownerChecked_, true);
    if (*owned != WindowOwnerCheck::Owned::No || !first) return {};
    return Error{fmt::format("the window {:#x} of the X display '{}' does not belong to the program, which may have "
                             "ended; its pictures are not drawn",
                             config_.window, x_->displayName())};
}

// Reads the window's pixel format and size. A missing window is not an error.
Result<void> AppWindow::adopt(Deadline deadline) {
    xcb_connection_t* c = x_->get();
    const auto attributesCookie = xcb_get_window_attributes(c, config_.window);
    const auto geometryCookie = xcb_get_geometry(c, config_.window);
    XOwned<xcb_get_window_attributes_reply_t> attributes;
    XOwned<xcb_get_geometry_reply_t> geometry;
    const XAnswer first = x_->await(attributesCookie.sequence, deadline, &attributes);
    if (first == XAnswer::TimedOut || first == XAnswer::ConnectionLost) {
        xcb_discard_reply(c, attributesCookie.sequence);
        xcb_discard_reply(c, geometryCookie.sequence);
        return missed(first);
    }
    const XAnswer second = x_->await(geometryCookie.sequence, deadline, &geometry);
    if (second == XAnswer::TimedOut || second == XAnswer::ConnectionLost) {
        xcb_discard_reply(c, geometryCookie.sequence);
        return missed(second);
    }
    windowGone_ = attributes == nullptr || geometry == nullptr;
    if (windowGone_) return {};
    if (Result<void> found = findConverter(attributes->visual, geometry->depth); !found) return found;
    if (gc_ != 0) xcb_free_gc(c, gc_);
    gc_ = xcb_generate_id(c);
    const uint32_t values[] = {XCB_SUBWINDOW_MODE_CLIP_BY_CHILDREN, 0 /* no exposure events */};
    xcb_create_gc(c, gc_, config_.window, XCB_GC_SUBWINDOW_MODE | XCB_GC_GRAPHICS_EXPOSURES, values);
    return {};
}

Result<void> AppWindow::findConverter(xcb_visualid_t visualId, int depth) {
    const xcb_visualtype_t* visual = findVisual(x_->setup(), visualId);
    const xcb_format_t* format = findFormat(x_->setup(), depth);
    const bool colours = visual != nullptr && (visual->_class == XCB_VISUAL_CLASS_TRUE_COLOR ||
                                               visual->_class == XCB_VISUAL_CLASS_DIRECT_COLOR);
    if (!colours || format == nullptr) {
        return Error{fmt::format("window {:#x} has no TrueColor visual (visual {:#x}, depth {}); "
                                 "use an X screen of 16, 24 or 30 bits",
                                 config_.window, visualId, depth)};
    }
    auto converter = PixelConverter::make(
        {depth, format->bits_per_pixel, format->scanline_pad, visual->red_mask, visual->green_mask, visual->blue_mask});
    if (!converter) {
        return Error{fmt::format("window {:#x} cannot be drawn: {}; use an X screen of 24 bits", config_.window,
                                 converter.error().message)};
    }
    converter_ = converter.value();
    return {};
}

Result<AppWindow::Outcome> AppWindow::showOnce(const Picture& picture, Deadline deadline) {
    const int width = std::min(picture.width, kLargestWindowSide);
    const int height = std::min(picture.height, kLargestWindowSide);
    const size_t sizeBytes = converter_->rowBytes(width) * static_cast<size_t>(height);
    Result<void> put = sharedFor(sizeBytes, deadline) ? putShared(picture, width, height, deadline)
                                                      : putInPieces(picture, width, height, deadline);
    if (put) put = settle(0, deadline);
    if (!put) return put.error();
    return judge();
}

// Ensures shared memory of that size. Returns false if there is none.
bool AppWindow::sharedFor(size_t sizeBytes, Deadline deadline) {
    if (!config_.sharedMemory || sharedRefused_) return false;
    if (shared_ && shared_->sizeBytes() >= sizeBytes) return true;
    shared_.reset();
    shared_ = SharedPixels::attach(*x_, sizeBytes, deadline);
    sharedRefused_ = shared_ == nullptr && !deadline.passed();
    return shared_ != nullptr;
}

Result<void> AppWindow::putShared(const Picture& picture, int width, int height, Deadline deadline) {
    convert(picture, {0, picture.height - height, width, height}, shared_->data());
    const auto w = static_cast<uint16_t>(width);
    const auto h = static_cast<uint16_t>(height);
    sent(xcb_shm_put_image_checked(x_->get(), config_.window, gc_, w, h, 0, 0, w, h, 0, 0,
                                   static_cast<uint8_t>(converter_->format().depth), XCB_IMAGE_FORMAT_Z_PIXMAP, 0,
                                   shared_->segment(), 0));
    return settle(0, deadline);
}

// Sends bands as high as one request allows, and columns if one row is too long. The unanswered bytes never exceed the
// socket's buffer, so no write can block past the deadline.
Result<void> AppWindow::putInPieces(const Picture& picture, int width, int height, Deadline deadline) {
    const size_t requestBytes = size_t{x_->setup().maximum_request_length} * 4;
    const size_t roomBytes = std::min({config_.pieceBytes, requestBytes - kPutImageHeaderBytes, x_->bytesInFlight()});
    const int pieceWidth = std::clamp(static_cast<int>(roomBytes / converter_->bytesPerPixel()) - 4, 1, width);
    const int pieceHeight = std::clamp(static_cast<int>(roomBytes / converter_->rowBytes(pieceWidth)), 1, height);
    const size_t maxUnanswered = std::max<size_t>(x_->bytesInFlight() / roomBytes, 1);
    for (int top = 0; top < height; top += pieceHeight) {
        const int h = std::min(pieceHeight, height - top);
        for (int left = 0; left < width; left += pieceWidth) {
            const int w = std::min(pieceWidth, width - left);
            const size_t sizeBytes = converter_->rowBytes(w) * static_cast<size_t>(h);
            piece_.resize(sizeBytes);
            convert(picture, {left, picture.height - top - h, w, h}, piece_.data());
            sent(xcb_put_image_checked(x_->get(), XCB_IMAGE_FORMAT_Z_PIXMAP, config_.window, gc_,
                                       static_cast<uint16_t>(w), static_cast<uint16_t>(h), static_cast<int16_t>(left),
                                       static_cast<int16_t>(top), 0, static_cast<uint8_t>(converter_->format().depth),
                                       static_cast<uint32_t>(sizeBytes), reinterpret_cast<uint8_t*>(piece_.data())));
            if (Result<void> ready = settle(maxUnanswered - 1, deadline); !ready || firstError_)
                return ready; // after an error the id may belong to another window
        }
    }
    return {};
}

// `part` is in coordinates of the picture. X expects the topmost row first.
void AppWindow::convert(const Picture& picture, const PixelViewport& part, std::byte* target) const {
    const size_t rowBytes = converter_->rowBytes(part.w);
    for (int line = 0; line < part.h; ++line) {
        const std::byte* source =
            picture.row(part.top() - 1 - line) + static_cast<size_t>(part.x) * kPictureBytesPerPixel;
        converter_->convertRow(picture.format, source, part.w, target + rowBytes * static_cast<size_t>(line));
    }
}

void AppWindow::sent(xcb_void_cookie_t request) { unanswered_.push_back({request, x_->sendFence()}); }

// Waits until at most `keep` puts are unanswered.
Result<void> AppWindow::settle(size_t keep, Deadline deadline) {
    xcb_flush(x_->get());
    while (unanswered_.size() > keep) {
        const Put put = unanswered_.front();
        const XAnswer answer = x_->awaitFence(put.fence, deadline);
        if (answer == XAnswer::TimedOut || answer == XAnswer::ConnectionLost) return missed(answer);
        hasAnswered_ = true;
        unanswered_.pop_front();
        XOwned<xcb_generic_error_t> error(xcb_request_check(x_->get(), put.request));
        if (error != nullptr && firstError_ == nullptr) firstError_ = std::move(error);
    }
    return {};
}

// Derives the outcome from the errors of one picture.
Result<AppWindow::Outcome> AppWindow::judge() {
    if (firstError_ == nullptr) return Outcome::Done;
    const XOwned<xcb_generic_error_t> error = std::move(firstError_);
    if (error->error_code == kBadDrawable || error->error_code == kBadWindow) {
        windowGone_ = true;
        return Outcome::Done;
    }
    converter_.reset(); // another window may have the id now: read it again
    if (shared_ != nullptr && error->error_code != kBadMatch) {
        shared_.reset();
        sharedRefused_ = true;
    }
    return Outcome::Again;
}

} // namespace mural
