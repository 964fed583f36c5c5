// Receives pictures from the head, one per wish (nodes/head/preview/picture_wish.hpp). Used by the thread of its
// io_context.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>

#include "common/base/result.hpp"
#include "nodes/head/preview/picture_wish.hpp"
#include "nodes/output/picture.hpp"

namespace mural::page {

struct FeedPicture {
    std::shared_ptr<const OwnedPicture> picture;
    uint64_t frame = 0;                    // of the wall
    int sourceWidth = 0, sourceHeight = 0; // before the reduction
};

class PictureFeed : public std::enable_shared_from_this<PictureFeed> {
public:
    using OnPicture = std::function<void(Result<FeedPicture> picture)>;

    // path: of the head's socket for pages. Errors: the head gives no pictures.
    static Result<std::shared_ptr<PictureFeed>> connect(boost::asio::io_context& io, const std::string& path);
    ~PictureFeed();

    // Requests a picture of a later frame. Requires that no earlier wish waits. After close() nothing is called.
    void wish(const PictureWish& wish, OnPicture onPicture);
    [[nodiscard]] bool isWaiting() const { return onPicture_ != nullptr; }
    void close();

private:
    explicit PictureFeed(boost::asio::posix::stream_descriptor socket) : socket_(std::move(socket)) {}
    Result<void> growMemory(size_t bytes);
    void send();
    void awaitNotice();
    void take();
    void finish(Result<FeedPicture> picture);

    boost::asio::posix::stream_descriptor socket_;
    PictureWish wish_;
    OnPicture onPicture_;
    int memoryFd_ = -1; // to be sent with the next wish; -1: none
    std::byte* memory_ = nullptr;
    size_t memoryBytes_ = 0;
};

} // namespace mural::page
