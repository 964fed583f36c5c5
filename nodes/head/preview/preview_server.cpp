#include "nodes/head/preview/preview_server.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/base/clock.hpp"
#include "common/ipc/descriptor_message.hpp"
#include "common/ipc/user_socket.hpp"
#include "common/log/log.hpp"
#include "nodes/output/reduce_picture.hpp"

namespace mural {

namespace {

constexpr int kPageBacklog = 16;
constexpr int kNicePreview = 10; // below the threads that draw, send and assemble
constexpr int kAcceptRestMs = 50;
constexpr int64_t kAskEveryNs = 66 * kNsPerMs; // of the nodes: 15 pictures per second
constexpr int kPreviewSliceMs = 60'000;        // offers, pages and the destructor wake the thread earlier

Error previewError(const std::string& path, const std::string& why) {
    return Error{"the socket " + path + " cannot be opened: " + why + "; pages show no pictures of this session"};
}

} // namespace

PreviewServer::Memory::~Memory() {
    if (bytes != nullptr) munmap(bytes, size);
}

PreviewServer::Memory PreviewServer::mapped(FileDescriptor memory) {
    Memory result;
    const int seals = fcntl(memory.get(), F_GET_SEALS);
    struct stat facts {};
    if (seals < 0 || (seals & F_SEAL_SHRINK) == 0 || fstat(memory.get(), &facts) != 0 || facts.st_size <= 0)
        return result;
    const auto size = static_cast<size_t>(facts.st_size);
    void* at = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, memory.get(), 0);
    if (at == MAP_FAILED) return result;
    result.bytes = static_cast<std::byte*>(at);
    result.size = size;
    return result;
}

Result<std::unique_ptr<PreviewServer>> PreviewServer::start(const std::string& path, AreaOf areaOf, OnWanted onWanted) {
    auto listener = listenForUser(path, SOCK_SEQPACKET, kPageBacklog);
    if (!listener) return previewError(path, listener.error().message);
    FileDescriptor wake(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
    if (!wake.valid()) return previewError(path, std::string("eventfd: ") + std::strerror(errno));
    std::unique_ptr<PreviewServer> server(
        new PreviewServer(path, std::move(*listener), std::move(wake), std::move(areaOf), std::move(onWanted)));
    server->thread_ = std::thread([raw = server.get()] { raw->serve(); });
    return server;
}

PreviewServer::PreviewServer(std::string path, FileDescriptor listener, FileDescriptor wake, AreaOf areaOf,
                             OnWanted onWanted)
    : path_(std::move(path)),
      listener_(std::move(listener)),
      wake_(std::move(wake)),
      areaOf_(std::move(areaOf)),
      onWanted_(std::move(onWanted)) {}

PreviewServer::~PreviewServer() {
    stop_ = true;
    const uint64_t one = 1;
    [[maybe_unused]] const ssize_t n = write(wake_.get(), &one, sizeof one);
    if (thread_.joinable()) thread_.join();
    unlink(path_.c_str());
}

void PreviewServer::offer(int64_t frame, std::shared_ptr<const OwnedPicture> picture, int sourceWidth,
                          int sourceHeight) {
    const int width = sourceWidth > 0 ? sourceWidth : picture->width(),
              height = sourceHeight > 0 ? sourceHeight : picture->height();
    Latest next{std::move(picture), frame, width, height};
    {
        const std::lock_guard lock(mutex_);
        std::swap(latest_, next); // the earlier picture may be freed, which takes no lock
    }
    if (!hasWish_.load(std::memory_order_acquire)) return;
    const uint64_t one = 1;
    [[maybe_unused]] const ssize_t n = write(wake_.get(), &one, sizeof one);
}

PreviewServer::Latest PreviewServer::latest() const {
    const std::lock_guard lock(mutex_);
    return latest_;
}

void PreviewServer::serve() {
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNicePreview);
    while (!stop_) {
        std::vector<pollfd> polled{{listener_.get(), POLLIN, 0}, {wake_.get(), POLLIN, 0}};
        for (const Page& page : pages_) polled.push_back({page.socket.get(), POLLIN, 0});
        if (poll(polled.data(), polled.size(), askNodes()) < 0) continue;
        uint64_t count = 0;
        [[maybe_unused]] const ssize_t n = read(wake_.get(), &count, sizeof count);
        if (stop_) break;
        for (size_t i = 0; i < pages_.size(); ++i)
            if (polled[i + 2].revents != 0) receive(pages_[i]);
        std::erase_if(pages_, [](const Page& page) { return page.isGone; });
        if (polled[0].revents != 0) acceptPage();
        // Set before the look at the latest picture, so an offer in between wakes the thread again.
        hasWish_ = std::ranges::any_of(pages_, [](const Page& page) { return page.wish.has_value(); });
        const Latest now = latest();
        for (Page& page : pages_)
            if (now.picture && page.wish && static_cast<uint64_t>(now.frame) > page.wish->afterFrame &&
                suffices(now, *page.wish))
                fulfil(page, now);
        std::erase_if(pages_, [](const Page& page) { return page.isGone; });
    }
    pages_.clear();
}

// Requests pictures for the pages that wait. Returns the time for which the thread may wait, in ms.
int PreviewServer::askNodes() {
    if (!onWanted_) return kPreviewSliceMs;
    uint32_t width = 0, height = 0;
    for (const Page& page : pages_) {
        if (!page.wish) continue;
        width = std::max(width, page.wish->maxWidth);
        height = std::max(height, page.wish->maxHeight);
    }
    if (width == 0) return kPreviewSliceMs;
    const int64_t nowNs = monotonicNowNs(), leftNs = askedNs_ + kAskEveryNs - nowNs;
    if (leftNs > 0) return static_cast<int>(leftNs / kNsPerMs) + 1;
    askedNs_ = nowNs;
    onWanted_(width, height);
    return static_cast<int>(kAskEveryNs / kNsPerMs);
}

// A picture that was reduced for a smaller wish does not suffice.
bool PreviewServer::suffices(const Latest& latest, const PictureWish& wish) {
    return latest.picture->width() >= reducedSize(latest.sourceWidth, latest.sourceHeight,
                                                  static_cast<int>(wish.maxWidth), static_cast<int>(wish.maxHeight))
                                          .width;
}

void PreviewServer::acceptPage() {
    FileDescriptor socket(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    // Waits, because without a free descriptor the next accept4() would fail at once.
    if (!socket.valid() && (errno == EMFILE || errno == ENFILE)) poll(nullptr, 0, kAcceptRestMs);
    if (!socket.valid() || !isPeerOwnOrRoot(socket.get()) || pages_.size() >= kMaxPages) return;
    pages_.emplace_back().socket = std::move(socket);
}

void PreviewServer::receive(Page& page) {
    PictureWish wish;
    FileDescriptor memory;
    const ssize_t n = receiveWithDescriptor(page.socket.get(), std::as_writable_bytes(std::span(&wish, 1)), memory);
    if (n < 0 && errno == EAGAIN) return;
    const bool isValid = n == static_cast<ssize_t>(sizeof wish) && wish.version == kPictureWishVersion &&
                         wish.maxWidth > 0 && wish.maxHeight > 0 && wish.maxWidth <= INT32_MAX &&
                         wish.maxHeight <= INT32_MAX;
    if (!isValid) {
        page.isGone = true;
        return;
    }
    if (memory.valid()) page.memory = mapped(std::move(memory));
    page.wish = wish;
}

void PreviewServer::fulfil(Page& page, const Latest& latest) {
    const PictureWish wish = *page.wish;
    Picture source = latest.picture->view();
    const double scale = static_cast<double>(latest.sourceWidth) / source.width;
    if (source.format != PictureFormat::Bgra8) {
        eightBits_.resize(source.width, source.height);
        copyInto(eightBits_, 0, 0, source);
        source = eightBits_.view();
    }
    if (wish.source != kWallPicture) {
        const auto area = areaOf_(static_cast<int>(wish.source - 1));
        const PixelViewport whole{0, 0, source.width, source.height};
        const PixelViewport pixels = area ? intersect(apply(whole, *area), whole) : PixelViewport{};
        if (pixels.w <= 0 || pixels.h <= 0) return give(page, {PictureOutcome::NoSuchSource});
        part_ = cutOut(source, pixels);
        source = part_.view();
    }
    const ReducedSize size =
        reducedSize(source.width, source.height, static_cast<int>(wish.maxWidth), static_cast<int>(wish.maxHeight));
    PictureNotice notice;
    notice.width = static_cast<uint32_t>(size.width);
    notice.height = static_cast<uint32_t>(size.height);
    notice.sourceWidth = static_cast<uint32_t>(std::lround(source.width * scale));
    notice.sourceHeight = static_cast<uint32_t>(std::lround(source.height * scale));
    notice.frame = static_cast<uint64_t>(latest.frame);
    notice.bytes = uint64_t{notice.width} * notice.height * kPictureBytesPerPixel;
    if (notice.bytes > page.memory.size)
        notice.outcome = PictureOutcome::NeedsMemory;
    else
        reducePicture(source, size, page.memory.bytes);
    give(page, notice);
}

void PreviewServer::give(Page& page, const PictureNotice& notice) {
    page.wish.reset();
    const ssize_t n = send(page.socket.get(), &notice, sizeof notice, MSG_NOSIGNAL | MSG_DONTWAIT);
    // A page has one wish at a time, so the socket has room.
    if (n != static_cast<ssize_t>(sizeof notice)) page.isGone = true;
}

} // namespace mural
