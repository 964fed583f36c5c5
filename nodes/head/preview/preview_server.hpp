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
    // onWanted: requests a picture from the nodes, at most these sizes, while a page waits for one and the head may
    // have none itself. Called by the server's thread, several times per second. Empty: the head has all pictures.
    using AreaOf = std::function<std::optional<Viewport>(int node)>;
    using OnWanted = std::function<void(uint32_t maxWidth, uint32_t maxHeight)>;
    static Result<std::unique_ptr<PreviewServer>> start(const std::string& path, AreaOf areaOf, OnWanted onWanted = {});
    PreviewServer(const PreviewServer&) = delete;
    PreviewServer& operator=(const PreviewServer&) = delete;
    ~PreviewServer(); // removes the socket

    struct Latest {
        std::shared_ptr<const OwnedPicture> picture; // null: none yet
        int64_t frame = 0;
        int sourceWidth = 0, sourceHeight = 0; // before a reduction
    };
    // Any thread.
    [[nodiscard]] Latest latest() const;

    // Offers the latest picture of the wall. Does not block; any thread.
    // source: size before a reduction; 0: the picture's own.
    void offer(int64_t frame, std::shared_ptr<const OwnedPicture> picture, int sourceWidth = 0, int sourceHeight = 0);

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

    PreviewServer(std::string path, FileDescriptor listener, FileDescriptor wake, AreaOf areaOf, OnWanted onWanted);
    [[nodiscard]] int askNodes();
    [[nodiscard]] static bool suffices(const Latest& latest, const PictureWish& wish);
    void serve();
    void acceptPage();
    void receive(Page& page);
    void fulfil(Page& page, const Latest& latest);
    void give(Page& page, const PictureNotice& notice);
    static Memory mapped(FileDescriptor memory);

    const std::string path_;
    const FileDescriptor listener_;
    const FileDescriptor wake_; // eventfd
    const AreaOf areaOf_;
    const OnWanted onWanted_;
    int64_t askedNs_ = 0;     // the latest call of onWanted_
    std::vector<Page> pages_; // of the thread
    OwnedPicture eightBits_, part_;
    std::atomic<bool> hasWish_{false};
    std::atomic<bool> stop_{false};
    mutable std::mutex mutex_; // guards the members below
    Latest latest_;
    std::thread thread_;
};

} // namespace mural
