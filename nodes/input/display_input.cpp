#include "nodes/input/display_input.hpp"

#include <algorithm>
#include <cmath>
#include <xcb/xtest.h>

#include "common/base/clock.hpp"
#include "nodes/input/pointer_place.hpp"

namespace mural::input {

namespace {

constexpr int64_t kPlaceEveryNs = 200 * kNsPerMs; // the window may move
constexpr size_t kMaxTyped = 4096;                // characters of a text
constexpr Keysym kShift = 0xffe1, kShiftRight = 0xffe2, kLevel3 = 0xfe03;
constexpr Keysym kFirstModifier = 0xffe3, kLastModifier = 0xffee; // Control to Hyper, without Shift

} // namespace

Result<std::unique_ptr<DisplayInput>> DisplayInput::open(const ProgramDisplay& display) {
    XConnection connection = connectTo(display);
    if (!connection) return Error{"the program's display " + display.name + " cannot be opened"};
    const Answer<xcb_test_get_version_reply_t> version(xcb_test_get_version_reply(
        connection.get(), xcb_test_get_version(connection.get(), XCB_TEST_MAJOR_VERSION, XCB_TEST_MINOR_VERSION),
        nullptr));
    if (!version) return Error{"the display " + display.name + " has no XTEST extension, so it takes no input"};
    std::unique_ptr<DisplayInput> input(new DisplayInput(std::move(connection), display));
    if (!input->readKeyboard()) return Error{"the keyboard of the display " + display.name + " cannot be read"};
    return input;
}

DisplayInput::DisplayInput(XConnection connection, const ProgramDisplay& display)
    : connection_(std::move(connection)),
      root_(rootOf(connection_.get())),
      window_(display.window),
      isGiven_(window_ != 0),
      isPrivate_(display.isPrivate) {}

DisplayInput::~DisplayInput() {
    if (!isLost()) releaseAll();
}

bool DisplayInput::isLost() const { return xcb_connection_has_error(connection_.get()) != 0; }

int DisplayInput::fd() const { return xcb_get_file_descriptor(connection_.get()); }

bool DisplayInput::readKeyboard() {
    const xcb_setup_t* setup = xcb_get_setup(connection_.get());
    const auto count = static_cast<uint8_t>(setup->max_keycode - setup->min_keycode + 1);
    const Answer<xcb_get_keyboard_mapping_reply_t> reply(xcb_get_keyboard_mapping_reply(
        connection_.get(), xcb_get_keyboard_mapping(connection_.get(), setup->min_keycode, count), nullptr));
    if (!reply) return false;
    const xcb_keysym_t* first = xcb_get_keyboard_mapping_keysyms(reply.get());
    const int length = xcb_get_keyboard_mapping_keysyms_length(reply.get());
    map_ = KeyboardMap(setup->min_keycode, reply->keysyms_per_keycode, {first, first + length});
    free_ = map_.freeKeycodes();
    return true;
}

void DisplayInput::fake(uint8_t type, uint8_t detail, int x, int y) {
    xcb_test_fake_input(connection_.get(), type, detail, XCB_CURRENT_TIME, root_, static_cast<int16_t>(x),
                        static_cast<int16_t>(y), 0);
}

bool DisplayInput::placeWindow() {
    const int64_t nowNs = monotonicNowNs();
    if (width_ > 0 && nowNs - placedNs_ < kPlaceEveryNs) return true;
    placedNs_ = nowNs;
    if (!isGiven_) window_ = largestWindow(connection_.get());
    const auto geometryCookie = xcb_get_geometry(connection_.get(), window_);
    const auto placeCookie = xcb_translate_coordinates(connection_.get(), window_, root_, 0, 0);
    const Answer<xcb_get_geometry_reply_t> geometry(xcb_get_geometry_reply(connection_.get(), geometryCookie, nullptr));
    const Answer<xcb_translate_coordinates_reply_t> place(
        xcb_translate_coordinates_reply(connection_.get(), placeCookie, nullptr));
    if (!geometry || !place) return false;
    left_ = place->dst_x;
    top_ = place->dst_y;
    width_ = geometry->width;
    height_ = geometry->height;
    return true;
}

void DisplayInput::moveTo(const InputEvent& event) {
    if (event.isOfDisplay) {
        const xcb_screen_t* const screen = xcb_setup_roots_iterator(xcb_get_setup(connection_.get())).data;
        fake(XCB_MOTION_NOTIFY, 0, pixelAt(event.x, screen->width_in_pixels),
             pixelAt(event.y, screen->height_in_pixels));
    } else if (placeWindow()) {
        fake(XCB_MOTION_NOTIFY, 0, left_ + pixelAt(event.x, width_), top_ + pixelAt(event.y, height_));
    }
}

void DisplayInput::button(uint8_t number, bool isDown) {
    if (isDown == buttons_.contains(number)) return; // such as an event after a release of all
    if (isDown)
        buttons_.insert(number);
    else
        buttons_.erase(number);
    fake(isDown ? XCB_BUTTON_PRESS : XCB_BUTTON_RELEASE, number);
}

// Windows of one program have the same upper bits, which the server gives to its connection.
bool DisplayInput::isOfProgram(xcb_window_t window) const {
    const uint32_t mask = xcb_get_setup(connection_.get())->resource_id_mask;
    return window != XCB_NONE && (window & ~mask) == (window_ & ~mask);
}

// A window manager's frame contains the program's window, so all windows below the pointer count.
bool DisplayInput::isBelowPointer() {
    for (xcb_window_t window = root_; window != XCB_NONE;) {
        const Answer<xcb_query_pointer_reply_t> pointer(
            xcb_query_pointer_reply(connection_.get(), xcb_query_pointer(connection_.get(), window), nullptr));
        if (!pointer) return false;
        window = pointer->child;
        if (isOfProgram(window)) return true;
    }
    return false;
}

bool DisplayInput::hasFocus() {
    const Answer<xcb_get_input_focus_reply_t> focus(
        xcb_get_input_focus_reply(connection_.get(), xcb_get_input_focus(connection_.get()), nullptr));
    if (!focus) return false;
    return focus->focus == XCB_INPUT_FOCUS_POINTER_ROOT ? isBelowPointer() : isOfProgram(focus->focus);
}

// A private display has no other programs.
bool DisplayInput::reachesProgram(const InputEvent& event) {
    const bool isPress = event.kind == InputKind::Down || event.kind == InputKind::Wheel ||
                         (event.kind == InputKind::Touch && event.isDown);
    const bool isTyped = event.kind == InputKind::Text || (event.kind == InputKind::Key && event.isDown);
    if (isPrivate_ || (!isPress && !isTyped) || !placeWindow()) return true;
    refusal_.clear();
    if (isPress && !isBelowPointer()) refusal_ = "another window covers the program's window; move one of them";
    if (isTyped && !hasFocus()) refusal_ = "another window has the keyboard; click into the program's window";
    return refusal_.empty();
}

void DisplayInput::wheel(double& sum, double add, uint8_t less, uint8_t more) {
    for (const int step : wheelSteps(sum, add)) {
        const uint8_t number = step < 0 ? less : more;
        fake(XCB_BUTTON_PRESS, number);
        fake(XCB_BUTTON_RELEASE, number);
    }
}

void DisplayInput::send(const InputEvent& event) {
    constexpr uint8_t kUp = 4, kDown = 5, kLeft = 6, kRight = 7;
    if (event.hasPlace) moveTo(event);
    if (!reachesProgram(event)) return;
    const auto number = static_cast<uint8_t>(event.button > 3 ? event.button + 4 : event.button); // 4 to 7: the wheel
    switch (event.kind) {
    case InputKind::Move: break;
    case InputKind::Down: button(number, true); break;
    case InputKind::Up: button(number, false); break;
    case InputKind::Touch: button(1, event.isDown); break;
    case InputKind::Wheel:
        wheel(wheelY_, event.wheelY, kUp, kDown);
        wheel(wheelX_, event.wheelX, kLeft, kRight);
        break;
    case InputKind::Key: key(event); break;
    case InputKind::Text: type(event.text); break;
    case InputKind::Blur: releaseAll(); break;
    case InputKind::Size: resize(event.width, event.height); break;
    case InputKind::Close: close(); break;
    }
    xcb_flush(connection_.get());
}

// Requests a size of the program's window, as a user does with a window manager.
void DisplayInput::resize(int width, int height) {
    if (!placeWindow() || window_ == root_ || width <= 0 || height <= 0) return;
    const std::array<uint32_t, 2> size{static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
    xcb_configure_window(connection_.get(), window_, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT, size.data());
    width_ = 0; // the next event asks for the place again
}

xcb_atom_t DisplayInput::atomOf(std::string_view name) {
    const Answer<xcb_intern_atom_reply_t> reply(xcb_intern_atom_reply(
        connection_.get(), xcb_intern_atom(connection_.get(), 0, static_cast<uint16_t>(name.size()), name.data()),
        nullptr));
    return reply ? reply->atom : xcb_atom_t{XCB_ATOM_NONE};
}

// Requests the end of the program's window (ICCCM 4.2.8.1). Programs without that protocol ignore the message.
void DisplayInput::close() {
    if (!placeWindow() || window_ == root_) return;
    xcb_client_message_event_t message{};
    message.response_type = XCB_CLIENT_MESSAGE;
    message.format = 32;
    message.window = window_;
    message.type = atomOf("WM_PROTOCOLS");
    message.data.data32[0] = atomOf("WM_DELETE_WINDOW");
    message.data.data32[1] = XCB_CURRENT_TIME;
    xcb_send_event(connection_.get(), 0, window_, XCB_EVENT_MASK_NO_EVENT, reinterpret_cast<const char*>(&message));
}

bool DisplayInput::isHeld(Keysym keysym) const {
    return std::ranges::any_of(held_, [keysym](const auto& entry) { return entry.second.second == keysym; });
}

// A keysym without a keycode takes a free one.
KeyPlace DisplayInput::placeOf(Keysym keysym) {
    if (const auto found = map_.find(keysym)) return *found;
    if (free_.empty()) return {};
    const uint8_t keycode = free_.front();
    std::rotate(free_.begin(), free_.begin() + 1, free_.end());
    const std::vector<xcb_keysym_t> keysyms(static_cast<size_t>(map_.perKeycode()), keysym);
    xcb_change_keyboard_mapping(connection_.get(), 1, keycode, static_cast<uint8_t>(keysyms.size()), keysyms.data());
    map_.bind(keycode, keysym);
    // The server must have the mapping before the key.
    const Answer<xcb_get_input_focus_reply_t> done(
        xcb_get_input_focus_reply(connection_.get(), xcb_get_input_focus(connection_.get()), nullptr));
    return {keycode, KeyLevel::Plain};
}

std::vector<std::pair<uint8_t, bool>> DisplayInput::setLevel(KeyLevel level) {
    std::vector<std::pair<uint8_t, bool>> changed;
    const bool wantsShift = level == KeyLevel::Shift || level == KeyLevel::ShiftLevel3;
    const bool wantsLevel3 = level == KeyLevel::Level3 || level == KeyLevel::ShiftLevel3;
    const auto set = [&](Keysym keysym, bool wants, bool isDown) {
        const auto place = map_.find(keysym);
        if (!place || wants == isDown) return;
        fake(wants ? XCB_KEY_PRESS : XCB_KEY_RELEASE, place->keycode);
        changed.emplace_back(place->keycode, isDown);
    };
    set(kShift, wantsShift, isHeld(kShift) || (wantsShift && isHeld(kShiftRight)));
    if (!wantsShift) set(kShiftRight, false, isHeld(kShiftRight));
    set(kLevel3, wantsLevel3, isHeld(kLevel3));
    return changed;
}

void DisplayInput::restore(const std::vector<std::pair<uint8_t, bool>>& keys) {
    for (auto key = keys.rbegin(); key != keys.rend(); ++key)
        fake(key->second ? XCB_KEY_PRESS : XCB_KEY_RELEASE, key->first);
}

void DisplayInput::key(const InputEvent& event) {
    const std::string name = event.code.empty() ? event.key : event.code;
    if (!event.isDown) {
        const auto found = held_.find(name);
        if (found == held_.end()) return;
        fake(XCB_KEY_RELEASE, found->second.first);
        held_.erase(found);
        return;
    }
    if (held_.contains(name)) return; // the X server repeats held keys itself
    const Keysym keysym = event.keysym != kNoKeysym ? event.keysym : keysymOfKey(event.key, event.code);
    const KeyPlace place = placeOf(keysym);
    if (keysym == kNoKeysym || place.keycode == 0) return;
    const bool isModifier = keysym == kShift || keysym == kShiftRight || keysym == kLevel3 ||
                            (keysym >= kFirstModifier && keysym <= kLastModifier);
    // With Control or Alt the key is a shortcut, and its modifiers are those that the viewer holds.
    const bool isShortcut = std::ranges::any_of(held_, [](const auto& entry) {
        return entry.second.second >= kFirstModifier && entry.second.second <= kLastModifier;
    });
    const auto changed = isModifier || isShortcut ? std::vector<std::pair<uint8_t, bool>>() : setLevel(place.level);
    fake(XCB_KEY_PRESS, place.keycode);
    held_[name] = {place.keycode, keysym};
    restore(changed);
}

void DisplayInput::tap(Keysym keysym) {
    const KeyPlace place = placeOf(keysym);
    if (keysym == kNoKeysym || place.keycode == 0) return;
    const auto changed = setLevel(place.level);
    fake(XCB_KEY_PRESS, place.keycode);
    fake(XCB_KEY_RELEASE, place.keycode);
    restore(changed);
}

void DisplayInput::type(const std::string& text) {
    size_t count = 0;
    for (const char32_t character : codePointsOf(text)) {
        if (++count > kMaxTyped) return;
        tap(keysymOf(character));
    }
}

void DisplayInput::releaseAll() {
    for (const auto& [name, key] : held_) fake(XCB_KEY_RELEASE, key.first);
    held_.clear();
    for (const uint8_t number : buttons_) fake(XCB_BUTTON_RELEASE, number);
    buttons_.clear();
    wheelX_ = wheelY_ = 0;
    xcb_flush(connection_.get());
}

} // namespace mural::input
