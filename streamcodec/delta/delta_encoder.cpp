#include "streamcodec/delta/delta_encoder.hpp"

#include <algorithm>
#include <cstring>
#include <xxhash.h>

#include "streamcodec/delta/word_compare.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::delta {

namespace {

// Size of a patch that is cheaper than a search for a better position.
constexpr size_t kCheapPatchBytes = 8;
// Number of omitted entries that are tried before the index is searched.
constexpr size_t kMaxSkipped = 4;
constexpr uint32_t kIndexedOfRun = 2;
// A run is patched if spans and changed words take at most 1/kFewOf of its bytes.
constexpr size_t kFewOf = 4;
constexpr size_t kLongPacketBytes = 4096;
// Number of short records in the log that may be skipped when records are sent plain.
constexpr size_t kMaxSkippedRecords = 1024;

} // namespace

bool DeltaEncoder::next() {
    if (!restPlain_ && novelty_->many() && cut_.atRecord()) {
        keepRun();
        novelty_->sendRestPlain(log_->end());
        restPlain_ = true;
    }
    if (restPlain_) {
        const size_t from = cut_.at();
        if (walked_ != nullptr && cut_.atRecord())
            passWalkedRecords();
        else
            cut_.passShort();
        if (!plain_) batchDroppedBytes_ += cut_.at() - from;
        asBytes(from, cut_.at());
    }
    return cut_.next(piece_);
}

// Skips the following short records, using the known record offsets of the packet.
void DeltaEncoder::passWalkedRecords() {
    const auto& longAt = walked_->longAt;
    while (nextLong_ < longAt.size() && longAt[nextLong_] < cut_.at()) ++nextLong_;
    const bool toEnd = nextLong_ == longAt.size();
    const size_t sizeBytes = (toEnd ? packet_.size() : longAt[nextLong_]) - cut_.at();
    // the offsets include the number of records
    cut_.passed(toEnd && sizeBytes > 0 ? 1 : 0, sizeBytes, walked_->lastBytes);
}

void DeltaEncoder::add(uint32_t stream, std::span<const std::byte> packet, const RecordOffsets* walked) {
    if (stream != lastStream_) {
        control_.put(ControlOp::Stream);
        control_.number(stream);
        lastStream_ = stream;
    }
    const Dictionary::Opened opened = dictionary_.open(stream);
    if (opened.logIndex == streams_.size()) streams_.emplace_back();
    if (opened.fresh)
        streams_[opened.logIndex] =
            firstIndex_ ? std::move(firstIndex_) : std::make_unique<StreamIndex>(limits_.logItems);
    log_ = &dictionary_.log(opened.logIndex);
    index_ = &streams_[opened.logIndex]->items;
    runs_ = &streams_[opened.logIndex]->runs;
    novelty_ = &streams_[opened.logIndex]->novelty;
    restPlain_ = plain_;
    packet_ = packet;
    nextAt_ = kNowhere;
    first_ = true;
    cut_ = PacketCut(packet);
    // A damaged packet may end a record that it did not begin.
    const bool isWalked = walked != nullptr && walked->lastBytes <= packet.size() &&
                          (walked->longAt.empty() || walked->longAt.back() < packet.size());
    walked_ = isWalked ? walked : nullptr;
    novelty_->packetBegins(frames_, log_->end(), packet.size() >= kLongPacketBytes);
    const uint64_t pagesBefore = batchPageBytes_;
    nextLong_ = 0;
    while (next()) {
        if (piece_.page()) batchPageBytes_ += piece_.sizeBytes;
        if (runOn()) continue;
        keepRun();
        hashed_ = false;
        novelty_->another(log_->cursor);
        const bool isNew = !encodePiece();
        if (!piece_.page()) count(isNew);
    }
    keepRun();
    novelty_->packetEnds((batchPageBytes_ - pagesBefore) * 2 > packet.size());
    endsInValue_ = cut_.lastOpcode() == wire::kOpBlobBegin || cut_.lastOpcode() == wire::kOpBlobData;
    counts_.records += walked_ != nullptr ? walked_->records : cut_.records();
    if (!first_) index_->packetEnds(log_->end() - 1);
    settle();
    asBytes(cut_.at(), packet.size());
    control_.put(ControlOp::End);
    ++counts_.packets;
    counts_.rawBytes += packet.size();
    batchRawBytes_ += packet.size();
}

// Codes the current piece if it is the expected one.
bool DeltaEncoder::runOn() {
    if (runKnown()) return true;
    EntryLog& log = *log_;
    if (!log.contains(log.cursor)) return false;
    const DictionaryEntry item = log.at(log.cursor);
    if (!same(item, piece_)) return false;
    const bool record = !piece_.page() && cut_.atRecord();
    if (!record) keepRun();
    // The first entries of a run are indexed at their latest position, because changes between them are newest there.
    if (run_ < kIndexedOfRun) {
        run();
    } else {
        ++run_;
        if (!item.page) novelty_->found(log.cursor, 1);
        counts_.pageHits += item.page;
        index_->appendAgain(log.end(), log.cursor, item.sizeBytes);
        ++log.cursor;
        log.append(dictionary_.again(item));
    }
    if (!record) return true;
    const uint64_t text = dictionary_.text().writtenBefore(log.at(log.end() - 1).where);
    if (open_.items == 0) {
        open_ = {log.end() - 1, 0, text, 0, 0};
        openBytesAt_ = piece_.at;
    }
    open_.oldestText = std::min(open_.oldestText, text);
    ++open_.items;
    open_.sizeBytes += piece_.sizeBytes;
    openIsKnown_ = false;
    return true;
}

// Codes the current piece and its successors if they match a known run, with a single comparison.
bool DeltaEncoder::runKnown() {
    if (!cut_.atRecord() || piece_.page()) return false;
    EntryLog& log = *log_;
    RunCache::Run run = runs_->fromCursor(log);
    if (run.items < RunCache::kMinItems || dictionary_.text().oldSince(run.oldestText)) return false;
    const size_t maximum = std::min<size_t>(run.sizeBytes, packet_.size() - piece_.at);
    const size_t equal = equalBytes(runs_->bytesOf(run), packet_.data() + piece_.at, maximum);
    if (equal < run.sizeBytes) {
        const uint64_t from = run.position;
        uint32_t items = 0, sizeBytes = 0;
        for (; sizeBytes + log.at(from + items).sizeBytes <= equal; ++items)
            sizeBytes += log.at(from + items).sizeBytes;
        run.items = items, run.sizeBytes = sizeBytes;
    }
    if (run.items == 0) return false;
    if (pagesRun_ != 0) settle();
    const auto indexed = [&] { return run_ < kIndexedOfRun; };
    const uint64_t from = log.cursor;
    uint32_t done = 0;
    const uint64_t position = log.end();
    for (; done < run.items && indexed(); ++done) this->run();
    index_->appendAllAgain(log.end(), from + done, run.items - done,
                           [&](size_t i) { return uint32_t{log.at(from + done + i).sizeBytes}; });
    dictionary_.againAll(log, run.items - done);
    run_ += run.items - done;
    novelty_->found(from, run.items - done);
    cut_.passed(run.items - 1, run.sizeBytes - piece_.sizeBytes, log.at(log.end() - 1).sizeBytes);
    openIsKnown_ = open_.items == 0;
    if (openIsKnown_) {
        open_ = run;
        open_.position = position;
        openBytesAt_ = piece_.at;
    } else {
        open_.oldestText = std::min(open_.oldestText, run.oldestText);
        open_.items += run.items;
        open_.sizeBytes += run.sizeBytes;
    }
    return true;
}

// Ends the current run of short records.
void DeltaEncoder::keepRun() {
    if (open_.items >= RunCache::kMinItems && open_.sizeBytes <= RunCache::kMaxBytes) {
        if (!openIsKnown_) open_.bytesAt = runs_->keep(packet_.subspan(openBytesAt_, open_.sizeBytes));
        runs_->add(open_);
    }
    open_ = {};
}

// Tries alternatives from cheap to expensive: a small patch, an expected entry slightly later, another position with
// this pair of entries, stored pages, a large patch. Otherwise the piece is new.
bool DeltaEncoder::encodePiece() {
    const Piece piece = piece_;
    if (restPlain_) skipToLike(piece);
    if (skipTo(piece)) return true;
    if (patch(piece, piece.page() ? cheapPatchOfPage(piece) : kCheapPatchBytes)) return true;
    if (piece.page() && fromStore(true)) return true;
    if (seek()) return true;
    if (piece.page() && fromStore(false)) return true;
    // Words of short entries are predicted: even if all of them changed, a patch costs less than a new entry at the
    // right position.
    const bool indexed = !piece.page() && piece.sizeBytes >= MatchIndex::kMinIndexedBytes;
    if (patch(piece, indexed ? size_t{piece.sizeBytes} * 2 : maxPatchOfPage(piece))) return true;
    send(piece);
    return false;
}

// Counts a coded short record.
void DeltaEncoder::count(bool isNew) {
    if (isNew)
        novelty_->isNew();
    else
        novelty_->found(log_->cursor - 1, 1);
}

bool DeltaEncoder::same(DictionaryEntry item, const Piece& piece) const {
    return item.sizeBytes == piece.sizeBytes &&
           sameWords(dictionary_.bytesOf(item).data(), packet_.data() + piece.at, piece.sizeBytes);
}

bool DeltaEncoder::expects(size_t ahead, const Piece& piece) const {
    const uint64_t position = log_->cursor + ahead;
    return log_->contains(position) && same(log_->at(position), piece);
}

bool DeltaEncoder::skipTo(const Piece& piece) {
    for (size_t ahead = 1; ahead <= kMaxSkipped; ++ahead) {
        if (!expects(ahead, piece)) continue;
        settle();
        control_.put(DeltaOp::Skip, static_cast<uint32_t>(ahead));
        log_->cursor += ahead;
        run();
        return true;
    }
    return false;
}

// Between long records the log may contain short ones from frames that were not plain.
void DeltaEncoder::skipToLike(const Piece& piece) {
    const DictionaryEntry now{0, piece.sizeBytes, static_cast<uint32_t>(piece.page())};
    for (size_t ahead = 0; ahead <= kMaxSkippedRecords && log_->contains(log_->cursor + ahead); ++ahead) {
        const DictionaryEntry there = log_->at(log_->cursor + ahead);
        if (!there.like(now) && !there.page) continue;
        if (ahead == 0 || !there.like(now)) return;
        settle();
        control_.put(DeltaOp::Skip, static_cast<uint32_t>(ahead));
        log_->cursor += ahead;
        return;
    }
}

// Records of other commands are not patched: their words have other meanings, and the position is probably wrong.
bool DeltaEncoder::patch(const Piece& piece, size_t maxBytes) {
    if (!log_->contains(log_->cursor)) return false;
    const DictionaryEntry expected = log_->at(log_->cursor);
    if (expected.sizeBytes != piece.sizeBytes || expected.page != static_cast<uint32_t>(piece.page())) return false;
    const auto old = dictionary_.bytesOf(expected), now = bytesOf(piece);
    if (!piece.page() && std::memcmp(old.data(), now.data(), 4) != 0) return false;
    if (!patch_.find(old, now, maxBytes)) return false;
    settle();
    control_.put(DeltaOp::Patch, static_cast<uint32_t>(patch_.spans.size()));
    DictionaryEntry changed = expected;
    ++counts_.patches;
    if (piece.page()) {
        putPatch(now);
        ++log_->cursor;
        appendChangedPage(expected.where, piece);
        return true;
    }
    words_.begin(changed, old);
    size_t at = 0;
    for (const WordSpan& span : patch_.spans) {
        control_.span(span.unchanged, span.changed);
        at += size_t{span.unchanged} * 4;
        const size_t sizeBytes = size_t{span.changed} * 4;
        codeWords(at, old.subspan(at, sizeBytes), now.subspan(at, sizeBytes));
        at += sizeBytes;
    }
    words_.end();
    ++log_->cursor;
    const DictionaryEntry after = keep(piece, changed.model);
    const auto hash = static_cast<uint32_t>(hashOf(piece));
    if (expected.model == 0)
        append(after, hash);
    else
        appendUnfound(after, hash);
    return true;
}

// Writes patch_. Inline, because a span may be a single word and there are hundreds.
void DeltaEncoder::putPatch(std::span<const std::byte> now) {
    auto& spans = literals_[static_cast<size_t>(Section::Spans)].owned();
    auto& words = literals_[static_cast<size_t>(Section::Words)].owned();
    size_t to = words.size();
    words.resize(to + patch_.changedBytes);
    const std::byte* from = now.data();
    for (const WordSpan& span : patch_.spans) {
        putSpan(span.unchanged, span.changed,
                [&spans](uint32_t byte) { spans.push_back(static_cast<std::byte>(byte)); });
        from += size_t{span.unchanged} * 4;
        for (uint32_t i = 0; i < span.changed; ++i, to += 4, from += 4) std::memcpy(words.data() + to, from, 4);
    }
}

void DeltaEncoder::codeWords(size_t at, std::span<const std::byte> old, std::span<const std::byte> now) {
    for (size_t i = 0; i < old.size(); i += 4) {
        uint32_t before = 0, word = 0;
        std::memcpy(&before, old.data() + i, 4);
        std::memcpy(&word, now.data() + i, 4);
        words_.code(coder_, static_cast<uint32_t>((at + i) / 4), before, word);
    }
}

bool DeltaEncoder::seek() {
    const auto hash = static_cast<uint32_t>(hashOf(piece_));
    PacketCut ahead = cut_;
    Piece behind;
    uint32_t next = MatchIndex::kNothing;
    if (ahead.next(behind)) {
        nextAt_ = behind.at;
        nextHash_ = XXH3_64bits(packet_.data() + behind.at, behind.sizeBytes);
        next = static_cast<uint32_t>(nextHash_);
    }
    if (seekAt(hash, index_->find(hash, next, log_->end()))) return true;
    // An entry that changes every time occurred before at this position only, unless a pair matches.
    const bool changes = log_->contains(log_->cursor) && log_->at(log_->cursor).model != 0 &&
                         log_->at(log_->cursor).sizeBytes == piece_.sizeBytes;
    return !changes && piece_.sizeBytes >= MatchIndex::kMinIndexedBytes &&
           seekAt(hash, index_->find(hash, MatchIndex::kAnything, log_->end()));
}

// Most candidates are other entries: comparing the contiguous hashes first avoids cache misses on their bytes.
bool DeltaEncoder::seekAt(uint32_t hash, uint64_t position) {
    if (!log_->contains(position) || index_->hashAt(position) != hash || !same(log_->at(position), piece_))
        return false;
    settle();
    control_.put(DeltaOp::Seek, static_cast<uint32_t>(log_->end() - position));
    log_->cursor = position;
    run();
    return true;
}

void DeltaEncoder::send(const Piece& piece) {
    settle();
    const uint32_t words = piece.sizeBytes / 4;
    if (piece.page())
        control_.put(DeltaOp::NewPage, piece.sizeBytes == kPageBytes ? 0 : words);
    else
        control_.put(DeltaOp::NewText, words);
    literal(piece.page() ? Section::Pages : Section::Texts, bytesOf(piece));
    const DictionaryEntry item = keep(piece);
    log_->replaces(item);
    append(item, static_cast<uint32_t>(hashOf(piece)));
}

void DeltaEncoder::run() {
    if (pagesRun_ != 0) settle();
    ++run_;
    const DictionaryEntry item = log_->at(log_->cursor);
    if (item.page) ++counts_.pageHits;
    append(dictionary_.again(item), index_->hashAt(log_->cursor++));
}

void DeltaEncoder::append(DictionaryEntry item, uint32_t hash) {
    index_->append(log_->end(), hash, item.sizeBytes, first_);
    first_ = false;
    log_->append(item);
}

void DeltaEncoder::appendUnfound(DictionaryEntry item, uint32_t hash) {
    index_->appendUnfound(log_->end(), hash);
    first_ = false;
    log_->append(item);
}

DictionaryEntry DeltaEncoder::keep(const Piece& piece, uint32_t model) {
    if (!piece.page()) return dictionary_.addText(bytesOf(piece), model);
    return putPage(dictionary_.pages().take(), piece);
}

void DeltaEncoder::settle() {
    if (run_ != 0) control_.put(DeltaOp::Run, run_);
    if (pagesRun_ != 0) {
        control_.put(DeltaOp::Pages, pagesRun_);
        control_.number(pagesFrom_);
    }
    run_ = pagesRun_ = 0;
}

void DeltaEncoder::asBytes(size_t from, size_t to) {
    if (from == to) return;
    settle();
    const auto bytes = packet_.subspan(from, to - from);
    const RawRunSlots::SlotAdvice advised = rawRunSlots_.expect(lastStream_, bytes.size(), frames_);
    if (advised.advice == RawRunSlots::Advice::Compare && asChanged(advised.slot, bytes)) return;
    const bool keeps = advised.advice == RawRunSlots::Advice::Keep;
    control_.put(keeps ? ControlOp::CachedBytes : ControlOp::Bytes);
    if (keeps) {
        control_.number(advised.slot);
        dictionary_.runs().keep(advised.slot, bytes);
    }
    control_.number(static_cast<uint32_t>(bytes.size()));
    literals_[static_cast<size_t>(Section::Texts)].lend(bytes);
}

// Codes the bytes as changed words of the slot, if few have changed.
bool DeltaEncoder::asChanged(uint32_t slot, std::span<const std::byte> bytes) {
    const auto unchanged = dictionary_.runs().at(slot);
    const bool few = patch_.find(unchanged, bytes, bytes.size() / kFewOf) || patch_.spans.empty();
    rawRunSlots_.changed(slot, few);
    if (!few) return false;
    ++counts_.patches;
    control_.put(ControlOp::ChangedBytes);
    control_.number(slot);
    control_.number(static_cast<uint32_t>(patch_.spans.size()));
    putPatch(bytes);
    patch_.apply(bytes, unchanged);
    return true;
}

uint64_t DeltaEncoder::hashOf(const Piece& piece) {
    if (!hashed_) hash_ = piece.at == nextAt_ ? nextHash_ : XXH3_64bits(packet_.data() + piece.at, piece.sizeBytes);
    hashed_ = true;
    return hash_;
}

SectionBytes DeltaEncoder::finish() {
    control_.put(ControlOp::Done);
    return {coder_.finish(), literals_[1].bytes(), literals_[2].bytes(), literals_[3].bytes(), literals_[4].bytes()};
}

uint64_t DeltaEncoder::stagedBytes() const {
    uint64_t sum = coder_.sizeBytes();
    for (const auto& literal : literals_) sum += literal.size();
    return sum;
}

void DeltaEncoder::clear() {
    counts_.stagedBytes += stagedBytes();
    batchRawBytes_ = batchPageBytes_ = batchDroppedBytes_ = 0;
    coder_.clear();
    for (auto& literal : literals_) literal.clear();
}

} // namespace mural::delta
