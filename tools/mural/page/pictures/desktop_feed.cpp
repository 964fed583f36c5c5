#include "tools/mural/page/pictures/desktop_feed.hpp"

#include <chrono>
#include <sys/socket.h>
#include <utility>

#include <boost/asio/post.hpp>

#include "common/log/log.hpp"
#include "nodes/output/reduce_picture.hpp"
#include "tools/mural/page/pictures/desktop_eye.hpp"

namespace mural::page {

namespace {

constexpr std::chrono::milliseconds kLookAgain{16}, kOpenAgain{1000};

FeedPicture pictureFor(const PictureWish& wish, const Picture& display, uint64_t frame) {
    const ReducedSize size =
        reducedSize(display.width, display.height, static_cast<int>(wish.maxWidth), static_cast<int>(wish.maxHeight));
    const auto picture = std::make_shared<OwnedPicture>(size.width, size.height);
    reducePicture(display, size, picture->data());
    return {picture, frame, display.width, display.height};
}

} // namespace

std::shared_ptr<DesktopFeed> DesktopFeed::create(boost::asio::io_context& io) {
    std::shared_ptr<DesktopFeed> feed(new DesktopFeed(io));
    feed->thread_ = std::thread([raw = feed.get()] { raw->work(); }); // the destructor joins it
    return feed;
}

DesktopFeed::~DesktopFeed() {
    DesktopFeed::close();
    thread_.join();
}

void DesktopFeed::close() {
    onPicture_ = nullptr;
    const std::lock_guard lock(mutex_);
    stop_ = true;
    if (openFd_ >= 0) shutdown(openFd_, SHUT_RDWR); // a frozen X server must not keep this process
    changed_.notify_all();
}

void DesktopFeed::use(std::optional<input::ProgramDisplay> display) {
    const std::lock_guard lock(mutex_);
    if (display_ == display) return;
    display_ = std::move(display);
    changed_.notify_all();
}

void DesktopFeed::wish(const PictureWish& wish, OnPicture onPicture) {
    onPicture_ = std::move(onPicture);
    const std::lock_guard lock(mutex_);
    wish_ = wish;
    changed_.notify_all();
}

void DesktopFeed::take(FeedPicture picture) {
    if (const OnPicture onPicture = std::exchange(onPicture_, nullptr)) onPicture(std::move(picture));
}

void DesktopFeed::work() {
    std::unique_ptr<DesktopEye> eye;
    std::optional<input::ProgramDisplay> of;
    uint64_t frame = 0;
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (!display_ || !wish_) {
            changed_.wait_for(lock, std::chrono::seconds(60));
            continue;
        }
        const input::ProgramDisplay display = *display_;
        const PictureWish wish = *wish_;
        if (of != display || (eye && eye->isLost())) {
            openFd_ = -1;
            eye.reset();
        }
        lock.unlock();
        if (!eye) {
            auto opened = DesktopEye::open(display);
            if (opened)
                eye = std::move(*opened);
            else
                log::debug(log::Topic::Picture, opened.error().message);
            of = display;
        }
        lock.lock();
        openFd_ = eye ? eye->fd() : -1;
        if (stop_) break;
        if (!eye) {
            changed_.wait_for(lock, kOpenAgain);
            continue;
        }
        lock.unlock();
        if (eye->look()) ++frame;
        std::optional<FeedPicture> picture;
        if (frame > wish.afterFrame) picture = pictureFor(wish, eye->picture(), frame);
        lock.lock();
        if (!picture) {
            changed_.wait_for(lock, kLookAgain);
            continue;
        }
        wish_.reset();
        boost::asio::post(io_, [weak = weak_from_this(), picture = std::move(*picture)]() mutable {
            if (const auto self = weak.lock()) self->take(std::move(picture));
        });
    }
    openFd_ = -1;
}

} // namespace mural::page
