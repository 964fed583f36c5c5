#include "tools/mural/page/pictures/desktop_eye.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <xcb/damage.h>

namespace mural::page {

namespace {

constexpr int kRowsPerRequest = 256; // bounds the reply
constexpr std::byte kOpaqueAlpha{0xff};

bool hasPixelsOf32Bits(const xcb_setup_t* setup, uint8_t depth) {
    const xcb_format_t* const formats = xcb_setup_pixmap_formats(setup);
    const xcb_format_t* const end = formats + xcb_setup_pixmap_formats_length(setup);
    return setup->image_byte_order == XCB_IMAGE_ORDER_LSB_FIRST && depth >= 24 &&
           std::any_of(formats, end, [depth](const xcb_format_t& format) {
               return format.depth == depth && format.bits_per_pixel == 32;
           });
}

} // namespace

Result<std::unique_ptr<DesktopEye>> DesktopEye::open(const input::ProgramDisplay& display) {
    input::XConnection connection = input::connectTo(display);
    if (!connection) return Error{"the display " + display.name + " cannot be opened"};
    std::unique_ptr<DesktopEye> eye(new DesktopEye(std::move(connection)));
    if (auto begun = eye->begin(); !begun) return Error{"the display " + display.name + " " + begun.error().message};
    return eye;
}

Result<void> DesktopEye::begin() {
    xcb_connection_t* const x = connection_.get();
    const xcb_screen_t* const screen = xcb_setup_roots_iterator(xcb_get_setup(x)).data;
    if (!hasPixelsOf32Bits(xcb_get_setup(x), screen->root_depth)) return Error{"has no pixels of 32 bits"};
    const auto* const extension = xcb_get_extension_data(x, &xcb_damage_id);
    const bool hasDamage = extension != nullptr && extension->present != 0;
    const input::Answer<xcb_damage_query_version_reply_t> version(
        hasDamage ? xcb_damage_query_version_reply(x, xcb_damage_query_version(x, 1, 1), nullptr) : nullptr);
    if (!version) return Error{"has no DAMAGE extension, so it cannot be shown"};
    firstEvent_ = extension->first_event;
    root_ = screen->root;
    picture_.resize(screen->width_in_pixels, screen->height_in_pixels);
    changed_ = {0, 0, picture_.width(), picture_.height()};
    damage_ = xcb_generate_id(x);
    xcb_damage_create(x, damage_, root_, XCB_DAMAGE_REPORT_LEVEL_BOUNDING_BOX);
    xcb_flush(x);
    return {};
}

bool DesktopEye::isLost() const { return xcb_connection_has_error(connection_.get()) != 0; }

void DesktopEye::takeEvents() {
    while (const input::Answer<xcb_generic_event_t> event{xcb_poll_for_event(connection_.get())}) {
        if ((event->response_type & 0x7f) != firstEvent_ + XCB_DAMAGE_NOTIFY) continue;
        const xcb_rectangle_t& area = reinterpret_cast<const xcb_damage_notify_event_t*>(event.get())->area;
        const Box box{std::max<int>(area.x, 0), std::max<int>(area.y, 0),
                      std::min(area.x + area.width, picture_.width()),
                      std::min(area.y + area.height, picture_.height())};
        if (box.empty()) continue;
        if (changed_.empty())
            changed_ = box;
        else
            changed_ = {std::min(changed_.left, box.left), std::min(changed_.top, box.top),
                        std::max(changed_.right, box.right), std::max(changed_.bottom, box.bottom)};
    }
}

bool DesktopEye::look() {
    takeEvents();
    if (changed_.empty()) return false;
    // Changes after this request are reported again.
    xcb_damage_subtract(connection_.get(), damage_, XCB_NONE, XCB_NONE);
    return read(std::exchange(changed_, {}));
}

bool DesktopEye::read(const Box& box) {
    const int width = box.right - box.left;
    for (int top = box.top; top < box.bottom; top += kRowsPerRequest) {
        const int rows = std::min(kRowsPerRequest, box.bottom - top);
        const input::Answer<xcb_get_image_reply_t> image(xcb_get_image_reply(
            connection_.get(),
            xcb_get_image(connection_.get(), XCB_IMAGE_FORMAT_Z_PIXMAP, root_, static_cast<int16_t>(box.left),
                          static_cast<int16_t>(top), static_cast<uint16_t>(width), static_cast<uint16_t>(rows), ~0U),
            nullptr));
        const size_t rowBytes = static_cast<size_t>(width) * kPictureBytesPerPixel;
        if (!image ||
            static_cast<size_t>(xcb_get_image_data_length(image.get())) < rowBytes * static_cast<size_t>(rows))
            return false;
        const uint8_t* from = xcb_get_image_data(image.get());
        for (int y = top; y < top + rows; ++y, from += rowBytes) {
            std::byte* const to = picture_.row(picture_.height() - 1 - y) +
                                  static_cast<size_t>(box.left) * kPictureBytesPerPixel; // the lowest row is first
            std::memcpy(to, from, rowBytes);
            for (size_t alpha = 3; alpha < rowBytes; alpha += kPictureBytesPerPixel) to[alpha] = kOpaqueAlpha;
        }
    }
    return true;
}

} // namespace mural::page
