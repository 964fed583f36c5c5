// Pages of long records in the delta encoder: whether a page is patched, taken from the store, or new.
#include <algorithm>
#include <cstring>

#include "streamcodec/delta/delta_encoder.hpp"
#include "streamcodec/delta/entropy/pixel_filter.hpp"

namespace mural::delta {

namespace {

// Size of a patch of a page that is cheaper than a search for a better position.
constexpr size_t kCheapPagePatchBytes = 512;

size_t maxPatchOf(const Piece& piece) { return size_t{piece.sizeBytes} * 3 / 4; }

} // namespace

// New pixels take fewer bytes than changed pixels.
size_t DeltaEncoder::maxPatchOfPage(const Piece& piece) const {
    if (piece.sizeBytes != kPageBytes) return maxPatchOf(piece);
    return std::clamp(leftOfPixels(packet_.data() + piece.at), kCheapPagePatchBytes, maxPatchOf(piece));
}

// A page that changes every time is not searched for.
size_t DeltaEncoder::cheapPatchOfPage(const Piece& piece) {
    if (!log_->contains(log_->cursor)) return 0;
    const DictionaryEntry expected = log_->at(log_->cursor);
    return expected.page && dictionary_.pages().changesInPlace(expected.where) ? maxPatchOf(piece)
                                                                               : kCheapPagePatchBytes;
}

// In place: the next expected page follows the replaced one.
bool DeltaEncoder::fromStore(bool inPlace) {
    const Piece piece = piece_;
    if (inPlace) {
        PacketCut ahead = cut_;
        Piece behind;
        if (!(ahead.next(behind) && log_->contains(log_->cursor) &&
              log_->at(log_->cursor).sizeBytes == piece.sizeBytes && expects(1, behind)))
            return false;
    }
    PageStore& pages = dictionary_.pages();
    const uint32_t slot = pageIndex_.find(hashOf(piece), [&](uint32_t s) {
        const auto page = pages.at(s);
        return page.size() == piece.sizeBytes &&
               std::memcmp(page.data(), packet_.data() + piece.at, piece.sizeBytes) == 0;
    });
    if (slot == PageIndex::kNone) return false;
    if (run_ != 0 || pagesRun_ == 0 || slot != pagesFrom_ + pagesRun_) {
        settle();
        pagesFrom_ = slot;
    }
    ++pagesRun_;
    ++counts_.pageHits;
    const DictionaryEntry item = dictionary_.fromStore(slot, piece.sizeBytes);
    log_->replaces(item);
    append(item, static_cast<uint32_t>(hashOf(piece)));
    return true;
}

// Appends the new contents of the page in this slot. A page that stays in its slot changes every time and needs no
// hash.
void DeltaEncoder::appendChangedPage(uint32_t slotBefore, const Piece& piece) {
    const uint32_t slot = dictionary_.pages().changed(slotBefore);
    if (slot != slotBefore) return append(putPage(slot, piece), static_cast<uint32_t>(hashOf(piece)));
    pageIndex_.forget(slot);
    appendUnfound(dictionary_.addPage(slot, bytesOf(piece)), MatchIndex::kNothing);
}

DictionaryEntry DeltaEncoder::putPage(uint32_t slot, const Piece& piece) {
    pageIndex_.set(slot, hashOf(piece));
    ++counts_.newPages;
    return dictionary_.addPage(slot, bytesOf(piece));
}

} // namespace mural::delta
