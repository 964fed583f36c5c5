#include "tests/output/xvfb_server.hpp"

#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include "nodes/output/files/encoder_process.hpp"

namespace mural::test {

namespace {

constexpr int64_t kStartTimeoutMs = 30'000;
constexpr int64_t kAnswerTimeoutMs = 10'000;

// Xvfb writes its number and a newline when it accepts connections.
std::string readNumber(int fd, Deadline deadline) {
    std::string number;
    while (!deadline.passed()) {
        pollfd ready{fd, POLLIN, 0};
        ::poll(&ready, 1, static_cast<int>(deadline.leftNs(kNsPerS) / kNsPerMs) + 1);
        if (ready.revents == 0) continue;
        char c = 0;
        if (::read(fd, &c, 1) != 1) return {};
        if (c == '\n') return number;
        number += c;
    }
    return {};
}

} // namespace

Result<std::unique_ptr<XvfbServer>> XvfbServer::start(int width, int height, int depth,
                                                      const std::vector<std::string>& options) {
    const std::string program = findProgram("Xvfb");
    if (program.empty()) return Error{"no Xvfb in PATH: install Debian's package xvfb"};
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) return Error{"no pipe for Xvfb"};
    std::vector<std::string> arguments = {program,     "-displayfd", std::to_string(ends[1]),
                                          "-screen",   "0",          fmt::format("{}x{}x{}", width, height, depth),
                                          "-nolisten", "tcp",        "-noreset"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t pid = ::fork();
    if (pid == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        ::fcntl(ends[1], F_SETFD, 0);
        const int nowhere = ::open("/dev/null", O_WRONLY);
        ::dup2(nowhere, 2);
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    ::close(ends[1]);
    std::unique_ptr<XvfbServer> server(new XvfbServer);
    server->pid_ = pid;
    const std::string number = readNumber(ends[0], Deadline::inMs(kStartTimeoutMs));
    ::close(ends[0]);
    if (pid < 0 || number.empty()) return Error{"Xvfb did not start"};
    server->displayName_ = ":" + number;
    return server;
}

// Sends SIGTERM first, so that the server removes its lock file and its socket.
void XvfbServer::kill() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGTERM);
    ::kill(pid_, SIGCONT);
    const Deadline deadline = Deadline::inMs(kAnswerTimeoutMs);
    while (::waitpid(pid_, nullptr, WNOHANG) == 0) {
        if (deadline.passed()) ::kill(pid_, SIGKILL);
        ::poll(nullptr, 0, 5);
    }
    pid_ = -1;
}

Result<std::unique_ptr<XClient>> XClient::open(const std::string& displayName) {
    auto x = XConnection::open(displayName, Deadline::inMs(kAnswerTimeoutMs));
    if (!x) return x.error();
    return std::unique_ptr<XClient>(new XClient(std::move(x.value())));
}

const xcb_screen_t& XClient::screen() const { return *xcb_setup_roots_iterator(&x_->setup()).data; }

uint32_t XClient::makeWindow(int x, int y, int width, int height, uint32_t pixel, int depth, uint32_t parent) {
    const auto w = static_cast<uint16_t>(width);
    const auto h = static_cast<uint16_t>(height);
    xcb_visualid_t visual = screen().root_visual;
    if (depth == 0) depth = screen().root_depth;
    for (auto d = xcb_screen_allowed_depths_iterator(&screen()); d.rem > 0; xcb_depth_next(&d))
        if (d.data->depth == depth && depth != screen().root_depth)
            visual = xcb_depth_visuals_iterator(d.data).data->visual_id;
    const xcb_colormap_t colours = xcb_generate_id(get());
    xcb_create_colormap(get(), XCB_COLORMAP_ALLOC_NONE, colours, root(), visual);
    const uint32_t window = xcb_generate_id(get());
    const uint32_t values[] = {pixel, 0, 1 /* no window manager */, colours};
    xcb_create_window(get(), static_cast<uint8_t>(depth), window, parent != 0 ? parent : root(),
                      static_cast<int16_t>(x), static_cast<int16_t>(y), w, h, 0, XCB_WINDOW_CLASS_INPUT_OUTPUT, visual,
                      XCB_CW_BACK_PIXEL | XCB_CW_BORDER_PIXEL | XCB_CW_OVERRIDE_REDIRECT | XCB_CW_COLORMAP, values);
    xcb_map_window(get(), window);
    sync();
    return window;
}

void XClient::destroyWindow(uint32_t window) {
    xcb_destroy_window(get(), window);
    sync();
}

void XClient::unmapWindow(uint32_t window) {
    xcb_unmap_window(get(), window);
    sync();
}

void XClient::resizeWindow(uint32_t window, int width, int height) {
    const uint32_t values[] = {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
    xcb_configure_window(get(), window, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT, values);
    sync();
}

void XClient::sync() { x_->awaitFence(x_->sendFence(), Deadline::inMs(kAnswerTimeoutMs)); }

Result<XOwned<xcb_get_image_reply_t>> XClient::image(uint32_t window, int x, int y, int width, int height) {
    const auto request =
        xcb_get_image(get(), XCB_IMAGE_FORMAT_Z_PIXMAP, window, static_cast<int16_t>(x), static_cast<int16_t>(y),
                      static_cast<uint16_t>(width), static_cast<uint16_t>(height), ~0U);
    XOwned<xcb_get_image_reply_t> reply;
    XOwned<xcb_generic_error_t> error;
    const XAnswer answer = x_->await(request.sequence, Deadline::inMs(kAnswerTimeoutMs), &reply, &error);
    if (answer == XAnswer::Reply) return reply;
    return Error{fmt::format("GetImage of {}x{} at {},{} failed: X error {}", width, height, x, y,
                             error != nullptr ? error->error_code : 0)};
}

Result<OwnedPicture> XClient::see(uint32_t window, int x, int y, int width, int height) {
    auto got = image(window, x, y, width, height);
    if (!got) return got.error();
    const size_t sizeBytes = static_cast<size_t>(xcb_get_image_data_length(got->get()));
    OwnedPicture picture(width, height);
    if (sizeBytes != picture.view().sizeBytes()) return Error{"the screen does not have 32 bits per pixel"};
    std::memcpy(picture.data(), xcb_get_image_data(got->get()), sizeBytes);
    flipRows(picture);
    return picture;
}

Result<uint32_t> XClient::pixelAt(uint32_t window, int x, int y) {
    auto got = image(window, x, y, 1, 1);
    if (!got) return got.error();
    uint32_t pixel = 0;
    std::memcpy(&pixel, xcb_get_image_data(got->get()),
                std::min<size_t>(sizeof pixel, static_cast<size_t>(xcb_get_image_data_length(got->get()))));
    return pixel;
}

} // namespace mural::test
