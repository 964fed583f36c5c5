// Gives pictures of the wall to pages (picture_wish.hpp). A thread of its own reduces and writes them, only while a
// page wishes one; otherwise the head only keeps a reference to the latest picture.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/result.hpp"
#include "common/geometry/viewport.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "nodes/head/preview/picture_wish.hpp"
#include "nodes/output/picture.hpp"

namespace mural {

class PreviewServer {
public:
    static constexpr size_t kMaxPages = 16;

    // path: of the socket; it gets mode 600. areaOf: the part of the wall that a node shows; nullopt: none. Called by
    // the server's thread.
    static Result<std::unique_ptr<PreviewServer>> start(const std::string& path,
                                                        std::function<std::optional<Viewport>(int node)> areaOf);
    PreviewServer(const PreviewServer&) = delete;
    PreviewServer& operator=(const PreviewServer&) = delete;
    ~PreviewServer(); // removes the socket

    struct Latest {
        std::shared_ptr<const OwnedPicture> picture; // null: none yet
        int64_t frame = 0;
    };
    // Any thread.
    [[nodiscard]] Latest latest() const;

    // Offers the latest picture of the wall. Does not block; any thread.
    void offer(int64_t frame, std::shared_ptr<const OwnedPicture> picture);

private:
    struct Memory {
        std::byte* bytes = nullptr;
        size_t size = 0;
        Memory() = default;
        Memory(Memory&& other) noexcept { swap(other); }
        Memory& operator=(Memory&& other) noexcept {
            swap(other);
            return *this;
        }
        Memory(const Memory&) = delete;
        Memory& operator=(const Memory&) = delete;
        ~Memory();
        void swap(Memory& other) noexcept {
            std::swap(bytes, other.bytes);
            std::swap(size, other.size);
        }
    };
    struct Page {
        FileDescriptor socket;
        Memory memory;
        std::optional<PictureWish> wish; // not yet fulfilled
        bool isGone = false;
    };

    PreviewServer(std::string path, FileDescriptor listener, FileDescriptor wake,
                  std::function<std::optional<Viewport>(int node)> areaOf);
    void serve();
    void acceptPage();
    void receive(Page& page);
    void fulfil(Page& page, uint64_t frame, const std::shared_ptr<const OwnedPicture>& picture);
    void give(Page& page, const PictureNotice& notice);
    static Memory mapped(FileDescriptor memory);

    const std::string path_;
    const FileDescriptor listener_;
    const FileDescriptor wake_; // eventfd
    const std::function<std::optional<Viewport>(int node)> areaOf_;
    std::vector<Page> pages_; // of the thread
    OwnedPicture eightBits_, part_;
    std::atomic<bool> hasWish_{false};
    std::atomic<bool> stop_{false};
    mutable std::mutex mutex_; // guards the members below
    std::shared_ptr<const OwnedPicture> latest_;
    int64_t latestFrame_ = 0;
    std::thread thread_;
};

} // namespace mural
