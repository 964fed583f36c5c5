#include "nodes/head/picture_assembler.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

namespace mural {
namespace {

using wire::PictureHeader;

constexpr uint32_t kMaxSide = 32768;
constexpr uint64_t kMaxPixels = uint64_t{1} << 28; // 16384 * 16384
constexpr size_t kMostOpenPictures = 4096;
constexpr size_t kKeptWindows = 8;  // more windows than that rarely swap; of each pass
constexpr size_t kKeptPictures = 6; // latest, in the output's queue, being shown

bool sensible(const PictureHeader& h) {
    if (h.windowWidth == 0 || h.windowHeight == 0) return h.w == 0 || h.h == 0;
    if (h.windowWidth > kMaxSide || h.windowHeight > kMaxSide) return false;
    if (uint64_t{h.windowWidth} * h.windowHeight > kMaxPixels) return false;
    return h.x >= 0 && h.y >= 0 && h.w >= 0 && h.h >= 0 &&
           int64_t{h.x} + h.w <= h.windowWidth && int64_t{h.y} + h.h <= h.windowHeight;
}

} // namespace

PictureAssembler::PictureAssembler(int nodes, Deliver deliver)
    : PictureAssembler(std::vector<int>(static_cast<size_t>(nodes), 0), {}, std::move(deliver)) {}

PictureAssembler::PictureAssembler(std::vector<int> passOf, Compose compose, Deliver deliver)
    : deliver_(std::move(deliver))
    , compose_(std::move(compose))
    , passOf_(std::move(passOf))
    , passes_(passOf_.empty() ? 1 : 1 + *std::ranges::max_element(passOf_))
    , living_(passOf_.size(), true) {}

Result<void> PictureAssembler::part(int node, const PictureHeader& header, ByteBuffer rows) {
    const auto index = static_cast<size_t>(node);
    if (!sensible(header)) return Error{"it sent a part that lies outside of its picture"};
    const std::lock_guard lock(mutex_);
    if (!living_[index]) return {};
    if (open_.size() >= kMostOpenPictures) return Error{"it is thousands of pictures ahead"};
    const auto at = open_.try_emplace({header.client, header.window, header.frame}).first;
    Open& open = at->second;
    open.done.resize(living_.size(), false);
    if (open.done[index]) return Error{"it sent two parts of one picture"};
    open.done[index] = true;
    open.parts.push_back({passOf_[index], header, std::move(rows)});
    if (complete(open)) finish(at);
    return {};
}

void PictureAssembler::frameDone(int node, uint32_t client, uint32_t window, uint32_t frame) {
    const std::lock_guard lock(mutex_);
    const auto at = open_.find({client, window, frame});
    if (at == open_.end()) {
        // Without a part of anybody yet there is nothing to complete; but others may still send
        // theirs, and must not wait for this node.
        Open open;
        open.done.resize(living_.size(), false);
        open.done[static_cast<size_t>(node)] = true;
        if (!complete(open) && open_.size() < kMostOpenPictures)
            open_.emplace(Key{client, window, frame}, std::move(open));
        return;
    }
    at->second.done[static_cast<size_t>(node)] = true;
    if (complete(at->second)) finish(at);
}

void PictureAssembler::nodeLost(int node) {
    const std::lock_guard lock(mutex_);
    living_[static_cast<size_t>(node)] = false;
    for (auto at = open_.begin(); at != open_.end();) // frames of a window in their order
        at = complete(at->second) ? finish(at) : std::next(at);
}

bool PictureAssembler::complete(const Open& open) const {
    for (size_t node = 0; node < living_.size(); ++node)
        if (living_[node] && !open.done[node]) return false;
    return true;
}

PictureAssembler::OpenPictures::iterator PictureAssembler::finish(OpenPictures::iterator at) {
    const auto& [client, window, frame] = at->first;
    const bool visible = std::ranges::any_of(
        at->second.parts, [](const Part& part) { return part.header.windowWidth > 0; });
    if (visible) {
        WindowPicture result;
        result.client = client;
        result.window = window;
        result.frame = frame;
        const PictureHeader& header = at->second.parts.back().header;
        result.nativeWindow = uint64_t{header.nativeHigh} << 32 | header.nativeLow;
        result.picture = assemble(client, window, at->second);
        if (result.picture) deliver_(std::move(result));
    }
    return open_.erase(at);
}

// Null when there is no memory for it.
std::shared_ptr<const OwnedPicture> PictureAssembler::assemble(uint32_t client, uint32_t window, const Open& open) {
    if (!compose_) return assemblePass({client, window, 0}, open);
    std::vector<std::shared_ptr<const OwnedPicture>> pictures;
    std::vector<Picture> views;
    for (int pass = 0; pass < passes_; ++pass) {
        pictures.push_back(assemblePass({client, window, pass}, open));
        if (!pictures.back()) return nullptr;
        views.push_back(pictures.back()->view());
    }
    auto whole = spare();
    try {
        compose_(views, *whole);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
    return whole;
}

// A pass of which nothing came (its nodes are lost) stays as it was; never seen, or of a window of another size, it is
// black.
std::shared_ptr<const OwnedPicture> PictureAssembler::assemblePass(const WindowKey& key, const Open& open) {
    const auto mine = [&](const Part& part) { return part.pass == std::get<2>(key) && part.header.windowWidth > 0; };
    const auto any = std::ranges::find_if(open.parts, mine);
    const auto before = latestOf(key);
    const auto seen = std::ranges::find_if(open.parts, [](const Part& part) { return part.header.windowWidth > 0; });
    const PictureHeader& size = any != open.parts.end() ? any->header : seen->header;
    const auto near = [](int now, uint32_t wanted) { return std::abs(now - static_cast<int>(wanted)) <= 1; }; // kernels' sizes differ by 1
    if (any == open.parts.end() && before && near(before->width(), size.windowWidth) && near(before->height(), size.windowHeight)) return before;
    const auto width = static_cast<int>(size.windowWidth);
    const auto height = static_cast<int>(size.windowHeight);
    auto picture = spare();
    try {
        picture->resize(width, height);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
    int64_t covered = 0;
    for (const Part& part : open.parts)
        if (mine(part)) covered += int64_t{part.header.w} * part.header.h;
    if (covered < int64_t{width} * height) {
        const bool sameSize = before && before->width() == width && before->height() == height;
        if (sameSize)
            std::memcpy(picture->data(), before->view().bgra, before->view().sizeBytes());
        else
            std::memset(picture->data(), 0, picture->view().sizeBytes());
    }
    for (const Part& part : open.parts)
        if (mine(part)) copyInto(*picture, part.header.x, part.header.y, Picture{part.header.w, part.header.h, part.rows.data()});
    keepLatest(key, picture);
    return picture;
}

// Fresh memory at every frame would be cleared and paged in each time: as dear as the assembly itself.
std::shared_ptr<OwnedPicture> PictureAssembler::spare() {
    for (const auto& picture : made_) {
        if (picture.use_count() > 1) continue;
        std::atomic_thread_fence(std::memory_order_acquire); // what its last reader did is over
        return picture;
    }
    auto picture = std::make_shared<OwnedPicture>();
    if (made_.size() < kKeptPictures * static_cast<size_t>(compose_ ? passes_ + 1 : 1)) made_.push_back(picture);
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
    if (latest_.size() > kKeptWindows * static_cast<size_t>(passes_)) latest_.pop_back();
}

} // namespace mural
