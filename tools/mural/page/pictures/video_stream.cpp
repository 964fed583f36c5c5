// The hub's H.264 streams: one encoder per class and source, whose units all of its viewers share.
#include <boost/asio/post.hpp>

#include "common/base/clock.hpp"
#include "common/log/log.hpp"
#include "tools/mural/page/pictures/picture_hub.hpp"

namespace mural::page {

// Small pictures twice a second gain nothing from motion.
bool PictureHub::usesVideo(const Watcher& watcher, const Key& key, const Channel& channel) {
    return watcher.decodesVideo && key.second != PictureClass::Thumb && !channel.hasVideoFailed &&
           channel.latest.picture != nullptr &&
           VideoEncoder::canEncode(channel.latest.picture->width(), channel.latest.picture->height());
}

// Encodes the latest picture, again as a key frame if a viewer needs one. Viewers whose pictures are in flight miss the
// unit, and need a key frame afterwards.
void PictureHub::encodeVideo(const Key& key, Channel& channel, bool wantsKey, int64_t nowNs) {
    const bool isKey = wantsKey && nowNs - channel.keyNs >= kKeyEveryNs;
    if (channel.isEncodingVideo || (channel.videoFrame == channel.latest.frame && !isKey)) return;
    if (!channel.video) channel.video = std::make_shared<VideoEncoder>();
    if (isKey) channel.keyNs = nowNs;
    channel.isEncodingVideo = true;
    channel.videoFrame = channel.latest.frame;
    ++totals_[static_cast<size_t>(key.second)].encodes;
    auto task = [this, key, isKey, latest = channel.latest, encoder = channel.video,
                 alive = std::weak_ptr<int>(alive_)] {
        auto unit = encoder->encode(latest.picture->view(), isKey);
        boost::asio::post(io_, [this, key, alive, encoder, frame = latest.frame, unit = std::move(unit)]() mutable {
            if (alive.expired()) return;
            const auto found = channels_.find(key);
            // A channel that was closed and opened again has another encoder.
            if (found != channels_.end() && found->second.video == encoder) takeUnit(key, frame, std::move(unit));
        });
    };
    boost::asio::post(encoder_, std::move(task));
}

void PictureHub::takeUnit(const Key& key, uint64_t frame, Result<VideoUnit> unit) {
    Channel& channel = channels_.at(key);
    const int64_t nowNs = monotonicNowNs();
    channel.isEncodingVideo = false;
    if (!unit) {
        log::warning(log::Topic::Picture, unit.error().message, "; pictures continue as JPEG");
        channel.hasVideoFailed = true;
        return pump(key, channel, nowNs);
    }
    if (unit->isKeyFrame) channel.keyNs = nowNs;
    const auto bytes = std::make_shared<const std::string>(std::move(unit->bytes));
    PartHeader header;
    header.kind = PartKind::H264;
    header.flags = static_cast<uint16_t>(kLastOfFrame | (unit->isKeyFrame ? kKeyFrame : 0));
    header.stream = key.first;
    header.frame = frame;
    header.pictureWidth = header.width = static_cast<uint16_t>(unit->width);
    header.pictureHeight = header.height = static_cast<uint16_t>(unit->height);
    for (auto& [number, watcher] : viewers_) {
        if (watcher.key != key || !usesVideo(watcher, key, channel)) continue;
        if (!watcher.flow.canSend() || (watcher.needsKey && !unit->isKeyFrame)) {
            watcher.needsKey = true;
            continue;
        }
        watcher.needsKey = false;
        header.lastInput = watcher.lastInput;
        watcher.sentFrame = frame;
        watcher.flow.sent(frame, nowNs);
        watcher.socket->sendBinary(partHeaderBytes(header, bytes->size()), bytes);
        count(key, bytes->size());
    }
    pump(key, channel, nowNs);
}

} // namespace mural::page
