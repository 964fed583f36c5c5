#include "economy/packer.hpp"

#include <cstring>
#include <xxhash.h>

#include "streamcodec/wire.hpp"

namespace mural::economy {

namespace {

// A patch that is cheaper than finding a better place.
constexpr size_t kCheapPatchBytes = 8;
// So many expected items may be missing before the index is asked.
constexpr size_t kMostSkipped = 4;

} // namespace

void Packer::add(uint32_t stream, std::span<const std::byte> packet) {
    if (stream != lastStream_) {
        control_.put(Other::Stream);
        control_.number(stream);
        lastStream_ = stream;
    }
    const History::Opened opened = history_.open(stream);
    if (opened.place == itemIndexes_.size()) itemIndexes_.emplace_back();
    if (opened.fresh) itemIndexes_[opened.place] = std::make_unique<ItemIndex>(limits_.logItems);
    log_ = &history_.log(opened.place);
    index_ = itemIndexes_[opened.place].get();
    packet_ = packet;
    first_ = true;
    const CutPacket cut = cutPacket(packet, pieces_);
    endsInValue_ = cut.lastOpcode == wire::kOpBlobBegin || cut.lastOpcode == wire::kOpBlobData;
    counts_.records += cut.records;
    for (size_t i = 0; i < pieces_.size(); ++i) {
        hashed_ = false;
        place(i);
    }
    if (!first_) index_->packetEnds(log_->end() - 1);
    settle();
    if (cut.sizeBytes < packet.size()) restAsBytes(cut.sizeBytes);
    control_.put(Other::End);
    ++counts_.packets;
    counts_.rawBytes += packet.size();
    batchRawBytes_ += packet.size();
}

// Cheapest first: what is expected, a few words of it changed, what was expected a little later, another place where this
// and the next came, pages that the nodes have, more words changed. Else it is new.
void Packer::place(size_t i) {
    const Piece& piece = pieces_[i];
    if (expects(0, piece)) return run();
    if (skipTo(piece)) return;
    if (patch(piece, kCheapPatchBytes)) return;
    if (piece.page() && fromStore(i, true)) return;
    if (seek(i)) return;
    if (piece.page() && fromStore(i, false)) return;
    if (patch(piece, size_t{piece.sizeBytes} * 3 / 4)) return;
    send(piece);
}

bool Packer::same(Item item, const Piece& piece) const {
    return item.sizeBytes == piece.sizeBytes && std::memcmp(history_.bytesOf(item).data(), packet_.data() + piece.at, piece.sizeBytes) == 0;
}

bool Packer::expects(size_t ahead, const Piece& piece) const {
    const uint64_t position = log_->cursor + ahead;
    return log_->holds(position) && same(log_->at(position), piece);
}

bool Packer::skipTo(const Piece& piece) {
    for (size_t ahead = 1; ahead <= kMostSkipped; ++ahead) {
        if (!expects(ahead, piece)) continue;
        settle();
        control_.put(Do::Skip, static_cast<uint32_t>(ahead));
        log_->cursor += ahead;
        run();
        return true;
    }
    return false;
}

// Records of another command are not patched: their words mean something else, and the place is most likely the wrong one.
bool Packer::patch(const Piece& piece, size_t mostBytes) {
    if (!log_->holds(log_->cursor)) return false;
    const Item expected = log_->at(log_->cursor);
    if (expected.sizeBytes != piece.sizeBytes || expected.page != static_cast<uint32_t>(piece.page())) return false;
    const auto old = history_.bytesOf(expected), now = bytesOf(piece);
    if (!piece.page() && std::memcmp(old.data(), now.data(), 4) != 0) return false;
    if (!patch_.find(old, now, mostBytes)) return false;
    settle();
    control_.put(Do::Patch, static_cast<uint32_t>(patch_.spans.size()));
    size_t at = 0;
    for (const WordSpan& span : patch_.spans) {
        control_.span(span.kept, span.changed);
        literal(Section::Words, now.subspan(at + size_t{span.kept} * 4, size_t{span.changed} * 4));
        at += (size_t{span.kept} + span.changed) * 4;
    }
    ++log_->cursor;
    ++counts_.patches;
    append(keep(piece), static_cast<uint32_t>(hashOf(piece)));
    return true;
}

bool Packer::seek(size_t i) {
    const auto hash = static_cast<uint32_t>(hashOf(pieces_[i]));
    const bool last = i + 1 == pieces_.size();
    const uint32_t next = last ? ItemIndex::kNothing : static_cast<uint32_t>(XXH3_64bits(packet_.data() + pieces_[i + 1].at, pieces_[i + 1].sizeBytes));
    return seekAt(pieces_[i], index_->find(hash, next, log_->end())) ||
           (pieces_[i].sizeBytes >= ItemIndex::kTellingBytes && seekAt(pieces_[i], index_->find(hash, ItemIndex::kAnything, log_->end())));
}

bool Packer::seekAt(const Piece& piece, uint64_t position) {
    if (!log_->holds(position) || !same(log_->at(position), piece)) return false;
    settle();
    control_.put(Do::Seek, static_cast<uint32_t>(log_->end() - position));
    log_->cursor = position;
    run();
    return true;
}

// In place: the page that comes next is expected behind the one that this takes the place of.
bool Packer::fromStore(size_t i, bool inPlace) {
    const Piece& piece = pieces_[i];
    if (inPlace && !(i + 1 < pieces_.size() && log_->holds(log_->cursor) && log_->at(log_->cursor).sizeBytes == piece.sizeBytes && expects(1, pieces_[i + 1]))) return false;
    PageStore& pages = history_.pages();
    const uint32_t slot = pageIndex_.find(hashOf(piece), [&](uint32_t s) {
        const auto page = pages.at(s);
        return page.size() == piece.sizeBytes && std::memcmp(page.data(), packet_.data() + piece.at, piece.sizeBytes) == 0;
    });
    if (slot == PageIndex::kNone) return false;
    if (run_ != 0 || pagesRun_ == 0 || slot != pagesFrom_ + pagesRun_) {
        settle();
        pagesFrom_ = slot;
    }
    ++pagesRun_;
    ++counts_.storeHits;
    const Item item = history_.again({slot, piece.sizeBytes, 1});
    log_->replaces(item);
    append(item, static_cast<uint32_t>(hashOf(piece)));
    return true;
}

void Packer::send(const Piece& piece) {
    settle();
    const uint32_t words = piece.sizeBytes / 4;
    if (piece.page()) control_.put(Do::NewPage, piece.sizeBytes == kPageBytes ? 0 : words);
    else control_.put(Do::NewText, words);
    literal(piece.page() ? Section::Pages : Section::Texts, bytesOf(piece));
    const Item item = keep(piece);
    log_->replaces(item);
    append(item, static_cast<uint32_t>(hashOf(piece)));
}

void Packer::run() {
    if (pagesRun_ != 0) settle();
    ++run_;
    const Item item = log_->at(log_->cursor);
    if (item.page) ++counts_.storeHits;
    const uint32_t hash = index_->hashAt(log_->cursor++);
    append(history_.again(item), hash);
}

void Packer::append(Item item, uint32_t hash) {
    index_->append(log_->end(), hash, item.sizeBytes, first_);
    first_ = false;
    log_->append(item);
}

Item Packer::keep(const Piece& piece) {
    if (!piece.page()) return history_.addText(bytesOf(piece));
    const uint32_t slot = history_.pages().take();
    pageIndex_.set(slot, hashOf(piece));
    ++counts_.newPages;
    return history_.addPage(slot, bytesOf(piece));
}

void Packer::settle() {
    if (run_ != 0) control_.put(Do::Run, run_);
    if (pagesRun_ != 0) {
        control_.put(Do::Pages, pagesRun_);
        control_.number(pagesFrom_);
    }
    run_ = pagesRun_ = 0;
}

void Packer::restAsBytes(size_t from) {
    control_.put(Other::Bytes);
    control_.number(static_cast<uint32_t>(packet_.size() - from));
    literal(Section::Texts, packet_.subspan(from));
}

uint64_t Packer::hashOf(const Piece& piece) {
    if (!hashed_) hash_ = XXH3_64bits(packet_.data() + piece.at, piece.sizeBytes);
    hashed_ = true;
    return hash_;
}

SectionBytes Packer::sections() { return {control_.bytes(), literals_[1], literals_[2], literals_[3]}; }

uint64_t Packer::stagedBytes() {
    uint64_t sum = 0;
    for (const auto section : sections()) sum += section.size();
    return sum;
}

void Packer::clear() {
    counts_.stagedBytes += stagedBytes();
    batchRawBytes_ = 0;
    control_.bytes().clear();
    for (auto& literal : literals_) literal.clear();
}

} // namespace mural::economy
