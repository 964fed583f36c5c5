// Receives pictures from the head, one per wish (nodes/head/preview/picture_wish.hpp). Used by the thread of its
// io_context.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>

#include "tools/mural/page/pictures/picture_source.hpp"

namespace mural::page {

class PictureFeed : public PictureSource, public std::enable_shared_from_this<PictureFeed> {
public:
    // path: of the head's socket for pages. Errors: the head gives no pictures.
    static Result<std::shared_ptr<PictureFeed>> connect(boost::asio::io_context& io, const std::string& path);
    ~PictureFeed() override;

    void wish(const PictureWish& wish, OnPicture onPicture) override;
    [[nodiscard]] bool isWaiting() const override { return onPicture_ != nullptr; }
    void close() override;

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
