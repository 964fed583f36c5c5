// Sends what the wall windows of a node show to the head, for pages. A thread of low priority reduces and encodes it,
// only after a request.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>

#include "nodes/render/windows/shown_tiles.hpp"
#include "streamcodec/wire/preview_tile.hpp"

namespace mural {

class PreviewSender {
public:
    // send: called by the thread, with the header and the encoded tile.
    using Send = std::function<void(std::span<const std::byte> header, std::span<const std::byte> jpeg)>;

    explicit PreviewSender(Send send);
    PreviewSender(const PreviewSender&) = delete;
    PreviewSender& operator=(const PreviewSender&) = delete;
    ~PreviewSender();

    // Does not block. A request that has not begun is replaced. shown: null has no effect.
    void request(const wire::WantPreviewCommand& command, std::shared_ptr<const ShownTiles> shown);

private:
    struct Wish {
        wire::WantPreviewCommand command;
        std::shared_ptr<const ShownTiles> shown;
    };
    void work();
    void reply(const Wish& wish, const Wish* previous);

    const Send send_;
    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::optional<Wish> next_;
    bool stop_ = false;
    std::thread thread_;
};

} // namespace mural
