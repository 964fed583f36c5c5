#include "nodes/render/windows/preview_sender.hpp"

#include <algorithm>
#include <chrono>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include "nodes/output/jpeg_picture.hpp"
#include "nodes/output/reduce_picture.hpp"

namespace mural {

namespace {

constexpr int kNiceSender = 10;     // below the threads that draw, and that send pictures
constexpr int kPreviewQuality = 90; // the page encodes the picture again

// Returns the place of an edge of a tile in the reduced picture.
int reducedEdge(int edge, int size, int reduced) {
    return static_cast<int>(int64_t{edge} * reduced / std::max(size, 1));
}

} // namespace

PreviewSender::PreviewSender(Send send) : send_(std::move(send)), thread_([this] { work(); }) {}

PreviewSender::~PreviewSender() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void PreviewSender::request(const wire::WantPreviewCommand& command, std::shared_ptr<const ShownTiles> shown) {
    if (!shown) return;
    {
        const std::lock_guard lock(mutex_);
        next_ = Wish{command, std::move(shown)};
    }
    changed_.notify_all();
}

void PreviewSender::work() {
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNiceSender);
    std::optional<Wish> previous;
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (!next_) {
            changed_.wait_for(lock, std::chrono::seconds(60));
            continue;
        }
        const Wish wish = *std::exchange(next_, std::nullopt);
        lock.unlock();
        reply(wish, previous ? &*previous : nullptr);
        previous = wish;
        lock.lock();
    }
}

void PreviewSender::reply(const Wish& wish, const Wish* previous) {
    const ShownTiles& shown = *wish.shown;
    const bool isSame = previous != nullptr && previous->shown == wish.shown &&
                        previous->command.maxWidth == wish.command.maxWidth &&
                        previous->command.maxHeight == wish.command.maxHeight;
    const ReducedSize size = reducedSize(shown.width, shown.height, static_cast<int>(wish.command.maxWidth),
                                         static_cast<int>(wish.command.maxHeight));
    for (size_t i = 0; i < shown.tiles.size(); ++i) {
        const PixelViewport& tile = shown.tiles[i];
        wire::PreviewTileHeader header{};
        header.number = wish.command.number;
        header.client = shown.client;
        header.frame = shown.frame;
        header.wallWidth = static_cast<uint32_t>(shown.width);
        header.wallHeight = static_cast<uint32_t>(shown.height);
        header.pictureWidth = static_cast<uint32_t>(size.width);
        header.pictureHeight = static_cast<uint32_t>(size.height);
        header.x = reducedEdge(tile.x, shown.width, size.width);
        header.y = reducedEdge(tile.y, shown.height, size.height);
        header.w = reducedEdge(tile.x + tile.w, shown.width, size.width) - header.x;
        header.h = reducedEdge(tile.y + tile.h, shown.height, size.height) - header.y;
        header.tiles = static_cast<uint32_t>(shown.tiles.size());
        header.tile = static_cast<uint32_t>(i);
        std::vector<std::byte> jpeg;
        Picture picture = shown.pictures[i].view();
        header.w = std::min(header.w, picture.width);
        header.h = std::min(header.h, picture.height);
        if (!isSame && !picture.empty() && header.w > 0 && header.h > 0) {
            OwnedPicture eightBits, reduced(header.w, header.h);
            if (picture.format != PictureFormat::Bgra8) {
                eightBits.resize(picture.width, picture.height);
                copyInto(eightBits, 0, 0, picture);
                picture = eightBits.view();
            }
            reducePicture(picture, {reduced.width(), reduced.height()}, reduced.data());
            jpeg = jpegOf(reduced.view(), kPreviewQuality);
        }
        send_(std::as_bytes(std::span(&header, 1)), jpeg);
    }
}

} // namespace mural
