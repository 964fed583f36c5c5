#include "tools/mural/page/pictures/picture_hub.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include "common/base/clock.hpp"
#include "common/log/log.hpp"
#include "tools/mural/page/pictures/desktop_feed.hpp"
#include "tools/mural/page/pictures/encode_picture.hpp"
#include "tools/mural/page/pictures/picture_feed.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;

constexpr int kBestQuality = 95; // of stills, with all of the colour
constexpr uint32_t kMaxNode = 100'000;
constexpr std::chrono::seconds kSnapshotPatience{5};

Result<std::optional<PictureClass>> classOf(const Json& arguments) {
    const auto value = arguments.find("class");
    if (value != arguments.end() && value->is_string()) {
        const auto& name = value->get_ref<const std::string&>();
        if (name == "off") return std::optional<PictureClass>();
        if (const auto found = pictureClassOfName(name)) return found;
    }
    return Error{"class: expected thumb, preview, full or off"};
}

Result<uint32_t> sourceOf(const Json& arguments) {
    const auto value = arguments.find("of");
    if (value == arguments.end() || *value == "wall") return kWallPicture;
    if (*value == "desktop") return kDesktopPicture;
    if (value->is_number_unsigned() && value->get<uint64_t>() <= kMaxNode) return 1 + value->get<uint32_t>();
    return Error{"of: expected \"wall\", \"desktop\" or the number of a node"};
}

} // namespace

PictureHub::PictureHub(boost::asio::io_context& io, std::string path, const PictureLimits& limits)
    : io_(io), path_(std::move(path)), limits_(limits) {}

PictureHub::~PictureHub() {
    alive_.reset();
    for (auto& [key, channel] : channels_) channel.feed->close();
    encoder_.join();
}

Result<Json> PictureHub::preview(int viewer, ViewerSocket& socket, bool decodesVideo, const Json& arguments) {
    for (const auto& [name, value] : arguments.items())
        if (name != "class" && name != "of") return Error{"unknown argument \"" + name.substr(0, 40) + "\""};
    auto wanted = classOf(arguments);
    if (!wanted) return wanted.error();
    auto source = sourceOf(arguments);
    if (!source) return source.error();
    if (!*wanted) {
        // A view of another source may have begun meanwhile.
        const auto found = viewers_.find(viewer);
        if (found != viewers_.end() && (!arguments.contains("of") || found->second.key.first == *source))
            forget(viewer);
        return Json::object();
    }
    if (*source == kDesktopPicture && !displayProblem_.empty()) return Error{displayProblem_};
    const Key key{*source, **wanted};
    if (!channels_.contains(key)) {
        auto feed = sourceFor(*source);
        if (!feed) return feed.error();
        channels_[key].feed = std::move(*feed);
    }
    Watcher& watcher = viewers_[viewer];
    const uint32_t lastInput = watcher.lastInput;
    watcher = {};
    watcher.socket = &socket;
    watcher.key = key;
    watcher.decodesVideo = decodesVideo;
    watcher.lastInput = lastInput;
    sendCursor(watcher);
    tick(monotonicNowNs());
    return Json::object();
}

Result<std::shared_ptr<PictureSource>> PictureHub::sourceFor(uint32_t source) {
    if (source != kDesktopPicture) {
        auto feed = PictureFeed::connect(io_, path_);
        if (!feed) return feed.error();
        return std::shared_ptr<PictureSource>(std::move(*feed));
    }
    auto feed = DesktopFeed::create(io_);
    feed->use(display_);
    return std::shared_ptr<PictureSource>(std::move(feed));
}

void PictureHub::setDisplay(std::optional<input::ProgramDisplay> display, const std::string& problem) {
    display_ = std::move(display);
    displayProblem_ = problem;
    for (auto& [key, channel] : channels_)
        if (key.first == kDesktopPicture) std::static_pointer_cast<DesktopFeed>(channel.feed)->use(display_);
}

void PictureHub::acknowledged(int viewer, uint64_t frame, int64_t nowNs) {
    const auto found = viewers_.find(viewer);
    if (found == viewers_.end()) return;
    found->second.flow.acknowledged(frame, nowNs);
    tick(nowNs);
}

void PictureHub::forget(int viewer) { viewers_.erase(viewer); }

// Returns whether the class shows a pointer.
bool PictureHub::showsCursor(const Key& key) {
    return (key.first == kWallPicture || key.first == kDesktopPicture) && key.second != PictureClass::Thumb;
}

bool PictureHub::isDisplayWatched() const {
    return std::ranges::any_of(viewers_, [](const auto& viewer) {
        return viewer.second.key.first == kDesktopPicture || showsCursor(viewer.second.key);
    });
}

void PictureHub::setCursor(const CursorState& cursor) {
    cursor_ = cursor;
    for (auto& [number, watcher] : viewers_) sendCursor(watcher);
}

// Sends the shape only if the viewer has another one.
void PictureHub::sendCursor(Watcher& watcher) {
    constexpr double kWhole = 65535;
    if (!cursor_.shape || !showsCursor(watcher.key)) return;
    const bool isDesktop = watcher.key.first == kDesktopPicture;
    const bool isNew = watcher.cursorShape != cursor_.shape;
    PartHeader header;
    header.kind = PartKind::Cursor;
    header.flags = isDesktop || cursor_.isInside ? 0 : kHidden;
    header.stream = watcher.key.first;
    header.x = static_cast<uint16_t>(std::lround((isDesktop ? cursor_.displayX : cursor_.x) * kWhole));
    header.y = static_cast<uint16_t>(std::lround((isDesktop ? cursor_.displayY : cursor_.y) * kWhole));
    header.width = static_cast<uint16_t>(cursor_.hotX);
    header.height = static_cast<uint16_t>(cursor_.hotY);
    header.pictureWidth = static_cast<uint16_t>(cursor_.width);
    header.pictureHeight = static_cast<uint16_t>(cursor_.height);
    const auto payload = isNew ? cursor_.shape : std::make_shared<const std::string>();
    watcher.cursorShape = cursor_.shape;
    watcher.socket->sendBinary(partHeaderBytes(header, payload->size()), payload);
}

void PictureHub::inputReached(int viewer, uint32_t number) {
    const auto found = viewers_.find(viewer);
    if (found != viewers_.end()) found->second.lastInput = number;
}

void PictureHub::tick(int64_t nowNs) {
    std::erase_if(channels_, [this](auto& entry) {
        const bool isWatched =
            std::ranges::any_of(viewers_, [&](const auto& viewer) { return viewer.second.key == entry.first; });
        if (!isWatched) entry.second.feed->close();
        return !isWatched;
    });
    for (auto& [key, channel] : channels_) pump(key, channel, nowNs);
}

void PictureHub::pump(const Key& key, Channel& channel, int64_t nowNs) {
    bool hasReady = false; // a viewer can take the next picture
    bool wantsUnit = false, wantsKey = false;
    for (auto& [number, watcher] : viewers_) {
        if (watcher.key != key || !watcher.flow.canSend()) continue;
        const uint64_t frame = channel.latest.frame;
        const bool isVideo = usesVideo(watcher, key, channel);
        if (channel.latest.picture == nullptr || watcher.sentFrame == frame) {
            hasReady = true;
            const bool rests = channel.latest.picture != nullptr && nowNs - channel.arrivedNs >= kRestNs;
            const int coding = watcher.flow.quality() == ViewerFlow::kQualities.front() ? kLossless : kFine;
            if (rests && watcher.stillFrame != frame) deliver(watcher, key, channel, coding, true, nowNs);
            continue;
        }
        if (isVideo) {
            wantsUnit = true;
            wantsKey = wantsKey || watcher.needsKey;
            hasReady = hasReady || channel.videoFrame == frame; // it waits for a key frame
            continue;
        }
        const int quality = std::max(1, limits_.quality * watcher.flow.quality() / 100);
        deliver(watcher, key, channel, quality, false, nowNs);
    }
    if (wantsUnit) encodeVideo(key, channel, wantsKey, nowNs);
    if (hasReady) wishNext(key, channel, nowNs);
}

// Sends the latest picture in this quality, or has it encoded first. Returns whether it was sent.
bool PictureHub::deliver(Watcher& watcher, const Key& key, Channel& channel, int quality, bool isStill, int64_t nowNs) {
    const auto found = channel.encoded.find(quality);
    if (found == channel.encoded.end()) {
        encode(key, channel, quality);
        return false;
    }
    if (found->second == nullptr) return false; // in progress
    PartHeader header;
    header.kind = quality == kLossless ? PartKind::Png : PartKind::Jpeg;
    header.flags = static_cast<uint16_t>(kKeyFrame | kLastOfFrame | (isStill ? kStill : 0));
    header.stream = key.first;
    header.frame = channel.latest.frame;
    header.lastInput = watcher.lastInput;
    header.pictureWidth = header.width = static_cast<uint16_t>(channel.latest.picture->width());
    header.pictureHeight = header.height = static_cast<uint16_t>(channel.latest.picture->height());
    send(watcher, channel, partHeaderBytes(header, found->second->size()), found->second, nowNs);
    if (isStill) watcher.stillFrame = header.frame;
    count(key, found->second->size());
    return true;
}

void PictureHub::count(const Key& key, size_t bytes) {
    Totals& totals = totals_[static_cast<size_t>(key.second)];
    ++totals.sent;
    totals.bytes += kPartHeaderBytes + bytes;
}

void PictureHub::send(Watcher& watcher, const Channel& channel, const std::string& header, const Encoded& bytes,
                      int64_t nowNs) {
    watcher.sentFrame = channel.latest.frame;
    watcher.flow.sent(channel.latest.frame, nowNs);
    watcher.socket->sendBinary(header, bytes);
}

void PictureHub::wishNext(const Key& key, Channel& channel, int64_t nowNs) {
    const ClassLimits limits = limitsOf(key.second, limits_);
    if (channel.feed->isWaiting() || nowNs - channel.wishedNs < limits.intervalNs) return;
    channel.wishedNs = nowNs;
    PictureWish wish;
    wish.source = key.first;
    wish.maxWidth = static_cast<uint32_t>(limits.maxWidth);
    wish.maxHeight = static_cast<uint32_t>(limits.maxHeight);
    wish.afterFrame = channel.latest.frame;
    channel.feed->wish(wish, [this, key](Result<FeedPicture> picture) {
        if (picture) return arrived(key, std::move(*picture));
        log::debug(log::Topic::Picture, picture.error().message); // the head ends, or the node has no part of the wall
    });
}

void PictureHub::arrived(const Key& key, FeedPicture picture) {
    const auto found = channels_.find(key);
    if (found == channels_.end()) return;
    Channel& channel = found->second;
    if (key.first == kWallPicture) {
        wallWidth_ = picture.sourceWidth;
        wallHeight_ = picture.sourceHeight;
    }
    channel.latest = std::move(picture);
    channel.encoded.clear();
    channel.arrivedNs = monotonicNowNs();
    pump(key, channel, channel.arrivedNs);
}

void PictureHub::encode(const Key& key, Channel& channel, int quality) {
    channel.encoded[quality] = nullptr;
    ++totals_[static_cast<size_t>(key.second)].encodes;
    auto task = [this, key, quality, latest = channel.latest, alive = std::weak_ptr<int>(alive_)] {
        const Picture picture = latest.picture->view();
        auto bytes = quality == kLossless ? encodePng(picture)
                     : quality == kFine   ? encodeJpeg(picture, kBestQuality, ChromaOf::All)
                                          : encodeJpeg(picture, quality, ChromaOf::Half);
        if (!bytes) return log::warning(log::Topic::Picture, bytes.error().message);
        auto shared = std::make_shared<const std::string>(std::move(*bytes));
        boost::asio::post(io_, [this, key, quality, alive, frame = latest.frame, shared = std::move(shared)] {
            if (alive.expired()) return;
            const auto found = channels_.find(key);
            if (found == channels_.end() || found->second.latest.frame != frame) return;
            found->second.encoded[quality] = shared;
            pump(key, found->second, monotonicNowNs());
        });
    };
    boost::asio::post(encoder_, std::move(task));
}

void PictureHub::snapshot(const Snapshot& snapshot, const std::function<void(Result<std::string> bytes)>& onDone) {
    auto connected = PictureFeed::connect(io_, path_);
    if (!connected) return onDone(connected.error());
    const ClassLimits limits = limitsOf(PictureClass::Full, limits_);
    PictureWish wish;
    wish.maxWidth = static_cast<uint32_t>(snapshot.maxWidth > 0 ? snapshot.maxWidth : limits.maxWidth);
    wish.maxHeight = static_cast<uint32_t>(limits.maxHeight);
    std::shared_ptr<PictureFeed> feed = std::move(*connected);
    const auto timer = std::make_shared<boost::asio::steady_timer>(io_, kSnapshotPatience);
    timer->async_wait([feed, onDone](const boost::system::error_code& error) {
        if (error) return; // the picture came in time
        feed->close();
        onDone(Error{"the program has drawn no picture yet"});
    });
    feed->wish(wish, [this, snapshot, feed, timer, onDone](Result<FeedPicture> picture) {
        timer->cancel();
        if (!picture) return onDone(picture.error());
        auto task = [this, snapshot, pixels = picture->picture, onDone, alive = std::weak_ptr<int>(alive_)] {
            auto bytes = snapshot.isPng ? encodePng(pixels->view())
                                        : encodeJpeg(pixels->view(), snapshot.quality,
                                                     snapshot.quality >= 90 ? ChromaOf::All : ChromaOf::Half);
            boost::asio::post(io_, [alive, onDone, bytes = std::move(bytes)] {
                if (!alive.expired()) onDone(bytes);
            });
        };
        boost::asio::post(encoder_, std::move(task));
    });
}

} // namespace mural::page
