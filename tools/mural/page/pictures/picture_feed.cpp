#include "tools/mural/page/pictures/picture_feed.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <utility>

#include <boost/asio/post.hpp>

#include "common/ipc/file_descriptor.hpp"

namespace mural::page {

namespace {

constexpr size_t kFirstMemoryBytes = size_t{320} * 320 * kPictureBytesPerPixel;
constexpr size_t kMaxMemoryBytes = size_t{1} << 30;

Error noPictures(const std::string& why) { return Error{"the head gives no pictures: " + why}; }

} // namespace

Result<std::shared_ptr<PictureFeed>> PictureFeed::connect(boost::asio::io_context& io, const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof address.sun_path) return noPictures("its path is too long");
    std::memcpy(address.sun_path, path.data(), path.size());
    FileDescriptor fd(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!fd.valid()) return noPictures(std::strerror(errno));
    if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        if (errno == ENOENT || errno == ECONNREFUSED)
            return noPictures("it receives none from the nodes; run with --display app, --display windows or --out");
        return noPictures(std::strerror(errno));
    }
    std::shared_ptr<PictureFeed> feed(new PictureFeed(boost::asio::posix::stream_descriptor(io, fd.release())));
    if (const auto grown = feed->growMemory(kFirstMemoryBytes); !grown) return grown.error();
    return feed;
}

PictureFeed::~PictureFeed() {
    if (memory_ != nullptr) munmap(memory_, memoryBytes_);
    if (memoryFd_ >= 0) ::close(memoryFd_);
}

Result<void> PictureFeed::growMemory(size_t bytes) {
    if (bytes > kMaxMemoryBytes) return noPictures("a picture is larger than 1 GiB");
    FileDescriptor fd(memfd_create("mural-page", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (!fd.valid() || ftruncate(fd.get(), static_cast<off_t>(bytes)) != 0 ||
        fcntl(fd.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) != 0)
        return noPictures(std::string("no shared memory: ") + std::strerror(errno));
    void* at = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd.get(), 0);
    if (at == MAP_FAILED) return noPictures(std::string("no shared memory: ") + std::strerror(errno));
    if (memory_ != nullptr) munmap(memory_, memoryBytes_);
    if (memoryFd_ >= 0) ::close(memoryFd_);
    memory_ = static_cast<std::byte*>(at);
    memoryBytes_ = bytes;
    memoryFd_ = fd.release();
    return {};
}

void PictureFeed::wish(const PictureWish& wish, OnPicture onPicture) {
    wish_ = wish;
    onPicture_ = std::move(onPicture);
    send();
}

// The socket has room, because one wish waits at a time.
void PictureFeed::send() {
    iovec part{&wish_, sizeof wish_};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    if (memoryFd_ >= 0) {
        message.msg_control = control;
        message.msg_controllen = sizeof control;
        cmsghdr* header = CMSG_FIRSTHDR(&message);
        header->cmsg_level = SOL_SOCKET;
        header->cmsg_type = SCM_RIGHTS;
        header->cmsg_len = CMSG_LEN(sizeof(int));
        std::memcpy(CMSG_DATA(header), &memoryFd_, sizeof memoryFd_);
    }
    if (sendmsg(socket_.native_handle(), &message, MSG_NOSIGNAL) != static_cast<ssize_t>(sizeof wish_)) {
        boost::asio::post(socket_.get_executor(),
                          [self = shared_from_this()] { self->finish(noPictures("it has ended")); });
        return;
    }
    if (memoryFd_ >= 0) ::close(std::exchange(memoryFd_, -1));
    awaitNotice();
}

void PictureFeed::awaitNotice() {
    socket_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                       [self = shared_from_this()](const boost::system::error_code& error) {
                           if (!error) self->take();
                       });
}

void PictureFeed::take() {
    PictureNotice notice;
    const ssize_t n = recv(socket_.native_handle(), &notice, sizeof notice, MSG_DONTWAIT);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return awaitNotice();
    if (n != static_cast<ssize_t>(sizeof notice)) return finish(noPictures("it has ended"));
    if (notice.outcome == PictureOutcome::NeedsMemory) {
        if (const auto grown = growMemory(notice.bytes); !grown) return finish(grown.error());
        return send();
    }
    if (notice.outcome != PictureOutcome::Written) return finish(noPictures("it has none of this node"));
    if (notice.bytes > memoryBytes_ || notice.bytes != uint64_t{notice.width} * notice.height * kPictureBytesPerPixel)
        return finish(noPictures("it sent an invalid size"));
    const Picture view{static_cast<int>(notice.width), static_cast<int>(notice.height), memory_};
    // A copy, because the next picture replaces these pixels while this one may still be encoded.
    finish(FeedPicture{std::make_shared<const OwnedPicture>(view), notice.frame, static_cast<int>(notice.sourceWidth),
                       static_cast<int>(notice.sourceHeight)});
}

void PictureFeed::finish(Result<FeedPicture> picture) {
    if (const OnPicture onPicture = std::exchange(onPicture_, nullptr)) onPicture(std::move(picture));
}

void PictureFeed::close() {
    onPicture_ = nullptr;
    boost::system::error_code ignored;
    socket_.close(ignored);
}

} // namespace mural::page
