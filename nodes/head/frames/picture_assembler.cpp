#include "nodes/head/frames/picture_assembler.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

#include "nodes/frame_spans/span_scope.hpp"
#include "nodes/head/frames/picture_place.hpp"

namespace mural {
namespace {

using wire::PictureHeader;

constexpr uint64_t kMaxPixels = uint64_t{1} << 28; // 16384 * 16384
constexpr size_t kMaxOpenPictures = 4096;
constexpr size_t kMaxWindows = 8;  // more windows rarely swap; per pass
constexpr size_t kMaxPictures = 6; // the latest, those in the output's queue, and the shown one

bool sensible(const PictureHeader& h) {
    if (h.format > static_cast<uint32_t>(kLastPictureFormat)) return false;
    if (h.windowWidth == 0 || h.windowHeight == 0) return h.w == 0 || h.h == 0;
    if (h.windowWidth > kMaxPictureSide || h.windowHeight > kMaxPictureSide) return false;
    if (uint64_t{h.windowWidth} * h.windowHeight > kMaxPixels) return false;
    return h.x >= 0 && h.y >= 0 && h.w >= 0 && h.h >= 0 && int64_t{h.x} + h.w <= h.windowWidth &&
           int64_t{h.y} + h.h <= h.windowHeight;
}

PictureFormat formatOf(const PictureHeader& h) { return static_cast<PictureFormat>(h.format); }

} // namespace

PictureAssembler::PictureAssembler(int nodes, Deliver deliver)
    : PictureAssembler(std::vector<int>(static_cast<size_t>(nodes), 0), {}, std::move(deliver)) {}

PictureAssembler::PictureAssembler(std::vector<int> passOf, Compose compose, Deliver deliver,
                                   std::vector<Compose> others, std::vector<Zoom> sizes)
    : deliver_(std::move(deliver)),
      compose_(std::move(compose)),
      others_(std::move(others)),
      sizes_(std::move(sizes)),
      passOf_(std::move(passOf)),
      passes_(passOf_.empty() ? 1 : 1 + *std::ranges::max_element(passOf_)),
      views_(passOf_.size()) {}

Result<void> PictureAssembler::part(int node, const PictureHeader& header, ByteBuffer rows) {
    const auto index = static_cast<size_t>(node);
    if (!sensible(header)) return Error{"it sent a part outside of its picture, or with an unknown pixel format"};
    const std::lock_guard lock(mutex_);
    if (!views_.isAlive(node)) return {};
    if (open_.size() >= kMaxOpenPictures) return Error{"it sent a picture number that is thousands ahead"};
    const auto at = opened(node, header.client, header.window, header.frame);
    Open& open = at->second;
    if (index >= open.awaited.size() || !open.awaited[index]) return {};
    if (open.done[index]) return Error{"it sent a part of a picture twice"};
    open.done[index] = true;
    open.parts.push_back({passOf_[index], header, std::move(rows)});
    settle(at);
    return {};
}

void PictureAssembler::frameDone(int node, uint32_t client, uint32_t window, uint32_t frame) {
    const auto index = static_cast<size_t>(node);
    const std::lock_guard lock(mutex_);
    if (!views_.isAlive(node)) return;
    const auto at = opened(node, client, window, frame);
    if (!at->second.awaited[index]) return;
    at->second.done[index] = at->second.finished[index] = true;
    settle(at);
}

void PictureAssembler::nodeLost(int node) {
    const std::lock_guard lock(mutex_);
    views_.lost(node);
    for (auto& [key, open] : open_) open.awaited[static_cast<size_t>(node)] = false;
    for (auto at = open_.begin(); at != open_.end();) at = settle(at); // keeps the order of a window's frames
}

void PictureAssembler::nodeJoins(int node, uint32_t view) {
    const std::lock_guard lock(mutex_);
    views_.joins(node, view);
}

void PictureAssembler::nodeInView(int node, uint32_t view) {
    const std::lock_guard lock(mutex_);
    views_.reached(node, view);
}

void PictureAssembler::clientGone(uint32_t client) {
    const std::lock_guard lock(mutex_);
    std::erase_if(open_, [&](const auto& entry) { return std::get<0>(entry.first) == client; });
    std::erase_if(latest_, [&](const auto& entry) { return std::get<0>(entry.first) == client; });
}

void PictureAssembler::release() {
    const std::lock_guard lock(mutex_);
    open_.clear();
    latest_.clear();
    made_.clear();
}

PictureAssembler::OpenPictures::iterator PictureAssembler::opened(int node, uint32_t client, uint32_t window,
                                                                  uint32_t frame) {
    const auto [at, fresh] = open_.try_emplace({client, window, frame});
    if (!fresh) return at;
    at->second.awaited = views_.awaited(node);
    at->second.done.resize(at->second.awaited.size(), false);
    at->second.finished.resize(at->second.awaited.size(), false);
    return at;
}

// Delivers the picture when no part is awaited. Erases the entry when all nodes have reported the frame. Returns the
// next entry.
PictureAssembler::OpenPictures::iterator PictureAssembler::settle(OpenPictures::iterator at) {
    Open& open = at->second;
    if (!open.delivered && allOf(open.awaited, open.done)) {
        open.delivered = true;
        deliver(at->first, open);
        open.parts.clear();
    }
    return allOf(open.awaited, open.finished) ? open_.erase(at) : std::next(at);
}

bool PictureAssembler::allOf(const std::vector<bool>& awaited, const std::vector<bool>& nodes) {
    for (size_t node = 0; node < awaited.size(); ++node)
        if (awaited[node] && !nodes[node]) return false;
    return true;
}

void PictureAssembler::deliver(const Key& key, const Open& open) {
    const SpanScope assembles(SpanKind::Assemble);
    const bool visible = std::ranges::any_of(open.parts, [](const Part& part) { return part.header.windowWidth > 0; });
    if (!visible) return;
    WindowPicture result;
    std::tie(result.client, result.window, result.frame) = key;
    const PictureHeader& header = open.parts.back().header;
    result.nativeWindow = uint64_t{header.nativeHigh} << 32 | header.nativeLow;
    assemble(result, open);
    if (result.picture) deliver_(std::move(result));
}

// Leaves the picture null without memory for it.
void PictureAssembler::assemble(WindowPicture& result, const Open& open) {
    std::vector<std::shared_ptr<const OwnedPicture>> pictures;
    std::vector<Picture> views;
    for (int pass = 0; pass < passes_; ++pass) {
        pictures.push_back(assemblePass({result.client, result.window, pass}, open));
        if (!pictures.back()) return;
        views.push_back(pictures.back()->view());
    }
    result.picture = compose_ ? composed(compose_, views) : pictures.front();
    for (const Compose& other : others_) result.others.push_back(composed(other, views));
}

std::shared_ptr<const OwnedPicture> PictureAssembler::composed(const Compose& compose,
                                                               const std::vector<Picture>& passes) {
    auto whole = spare();
    try {
        compose(passes, *whole);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
    return whole;
}

// Returns the picture of one pass. A pass without any part, whose nodes are lost, keeps its previous picture. Without
// one of the same size it is black.
std::shared_ptr<const OwnedPicture> PictureAssembler::assemblePass(const WindowKey& key, const Open& open) {
    const auto mine = [&](const Part& part) { return part.pass == std::get<2>(key) && part.header.windowWidth > 0; };
    const auto any = std::ranges::find_if(open.parts, mine);
    const auto before = latestOf(key);
    const auto seen = std::ranges::find_if(open.parts, [](const Part& part) { return part.header.windowWidth > 0; });
    PictureHeader size = any != open.parts.end() ? any->header : seen->header;
    if (any == open.parts.end() && !sizes_.empty()) { // the part belongs to another canvas
        const Zoom& from = sizes_[static_cast<size_t>(seen->pass)];
        const Zoom& to = sizes_[static_cast<size_t>(std::get<2>(key))];
        size.windowWidth =
            static_cast<uint32_t>(std::clamp<double>(std::round(size.windowWidth / from.x * to.x), 1, kMaxPictureSide));
        size.windowHeight = static_cast<uint32_t>(
            std::clamp<double>(std::round(size.windowHeight / from.y * to.y), 1, kMaxPictureSide));
    }
    // kernel sizes differ by 1
    const auto isClose = [](int now, uint32_t wanted) { return std::abs(now - static_cast<int>(wanted)) <= 1; };
    if (any == open.parts.end() && before && isClose(before->width(), size.windowWidth) &&
        isClose(before->height(), size.windowHeight))
        return before;
    const auto width = static_cast<int>(size.windowWidth);
    const auto height = static_cast<int>(size.windowHeight);
    auto format = PictureFormat::Bgra8; // becomes the deepest format of all parts
    for (const Part& part : open.parts)
        if (mine(part)) format = std::max(format, formatOf(part.header));
    auto picture = spare();
    try {
        picture->resize(width, height, format);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
    int64_t covered = 0;
    for (const Part& part : open.parts)
        if (mine(part)) covered += int64_t{part.header.w} * part.header.h;
    if (covered < int64_t{width} * height) {
        const bool sameSize = before && before->width() == width && before->height() == height;
        if (sameSize)
            copyInto(*picture, 0, 0, before->view());
        else
            std::memset(picture->data(), 0, picture->view().sizeBytes());
    }
    for (const Part& part : open.parts)
        if (mine(part))
            copyInto(*picture, part.header.x, part.header.y,
                     Picture{part.header.w, part.header.h, part.rows.data(), formatOf(part.header)});
    keepLatest(key, picture);
    return picture;
}

// Reuses memory. Fresh memory would be cleared and paged in at every frame, which costs as much as the assembly itself.
std::shared_ptr<OwnedPicture> PictureAssembler::spare() {
    for (const auto& picture : made_) {
        if (picture.use_count() > 1) continue;
        std::atomic_thread_fence(std::memory_order_acquire); // orders this after the accesses of its last reader
        return picture;
    }
    auto picture = std::make_shared<OwnedPicture>();
    if (made_.size() < kMaxPictures * (static_cast<size_t>(compose_ ? passes_ + 1 : passes_) + others_.size()))
        made_.push_back(picture);
    return picture;
}

std::shared_ptr<const OwnedPicture> PictureAssembler::latestOf(const WindowKey& key) const {
    for (const auto& [window, picture] : latest_)
        if (window == key) return picture;
    return nullptr;
}

void PictureAssembler::keepLatest(const WindowKey& key, std::shared_ptr<const OwnedPicture> picture) {
    std::erase_if(latest_, [&](const auto& entry) { return entry.first == key; });
    latest_.emplace_front(key, std::move(picture));
    if (latest_.size() > kMaxWindows * static_cast<size_t>(passes_)) latest_.pop_back();
}

} // namespace mural
