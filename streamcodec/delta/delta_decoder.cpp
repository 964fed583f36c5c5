#include "streamcodec/delta/delta_decoder.hpp"

#include <cstring>
#include <vector>

#include "common/base/copy_bytes.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::delta {

namespace {

// Bounds the number of operations. A valid batch has at most one per entry and a few per packet; well-compressed
// garbage could have any number.
constexpr uint32_t kMaxSteps = 1u << 23;

uint32_t opcodeOf(std::span<const std::byte> record) {
    uint32_t head = 0;
    if (record.size() >= sizeof head) std::memcpy(&head, record.data(), sizeof head);
    return head & 0xffff;
}

} // namespace

DeltaDecoder::DeltaDecoder(const Limits& limits)
    : dictionary_(limits),
      packet_(std::make_unique_for_overwrite<std::byte[]>(wire::kMaxPacketBytes)),
      words_(limits.modelWords) {}

void DeltaDecoder::begin(const SectionBytes& sections) {
    sections_ = sections;
    coder_ = RangeReader(sections[static_cast<size_t>(Section::Control)]);
    control_.clear();
    spans_ = SpanReader(PlainBytes(sections[static_cast<size_t>(Section::Spans)]));
    batchBytes_ = 0;
    steps_ = 0;
    done_ = false;
}

Result<bool> DeltaDecoder::next(uint32_t& stream, std::span<const std::byte>& packet) {
    packetBytes_ = 0;
    log_ = nullptr;
    for (ended_ = false; !ended_ && !done_;) {
        uint32_t n = 0;
        const DeltaOp what = control_.what(n);
        Problem problem = control_.bad() ? nullptr : step(what, n);
        if (control_.bad()) problem = "its control bytes end in the middle of a packet";
        if (!problem && ++steps_ > kMaxSteps) problem = "more steps than the maximum of a batch";
        if (problem)
            return Error{std::string("cannot decode the head's stream: ") + problem +
                         "; install the same version of mural on all machines"};
    }
    stream = stream_;
    packet = {packet_.get(), packetBytes_};
    return ended_;
}

DeltaDecoder::Problem DeltaDecoder::step(DeltaOp what, uint32_t n) {
    if (what == DeltaOp::ControlOp) return other(n);
    if (!log_) log_ = &dictionary_.log(dictionary_.open(stream_).logIndex);
    switch (what) {
    case DeltaOp::Run: return run(n);
    case DeltaOp::Patch: return patch(n);
    case DeltaOp::NewText:
        return n >= 1 && n <= kMaxTextBytes / 4 ? fresh(n * 4, false) : "a new record of invalid size";
    case DeltaOp::NewPage:
        return n == 0 || (n > kMaxTextBytes / 4 && n < kPageBytes / 4) ? fresh(n == 0 ? kPageBytes : n * 4, true)
                                                                       : "a new page of invalid size";
    case DeltaOp::Skip: log_->cursor += n; return nullptr;
    case DeltaOp::Seek:
        if (n == 0 || n > log_->end()) return "a reference before the first entry";
        log_->cursor = log_->end() - n;
        return nullptr;
    case DeltaOp::Pages: return pages(n);
    case DeltaOp::ControlOp: break;
    }
    return "an unknown control byte";
}

DeltaDecoder::Problem DeltaDecoder::run(uint32_t n) {
    while (n > 0) {
        if (!log_->contains(log_->cursor)) return "a reference to an unknown entry";
        if (const Dictionary::Stretch s = dictionary_.stretch(*log_, n); s.items > 0) {
            if (!room(s.bytes.size())) return "the packet or batch is too large";
            put(s.bytes);
            dictionary_.againAll(*log_, s.items);
            n -= static_cast<uint32_t>(s.items);
            continue;
        }
        --n;
        const DictionaryEntry item = log_->at(log_->cursor);
        if (!room(item.sizeBytes)) return "the packet or batch is too large";
        put(dictionary_.bytesOf(item));
        ++log_->cursor;
        log_->append(dictionary_.again(item));
    }
    return nullptr;
}

DeltaDecoder::Problem DeltaDecoder::patch(uint32_t spans) {
    if (!log_->contains(log_->cursor)) return "a delta of an unknown entry";
    DictionaryEntry item = log_->at(log_->cursor);
    if (!room(item.sizeBytes)) return "the packet or batch is too large";
    const auto bytes = put(dictionary_.bytesOf(item));
    std::vector<std::byte> old;
    if (loseWords_ && opcodeOf(bytes) >= wire::kFirstGlOpcode) old.assign(bytes.begin(), bytes.end());
    if (const Problem problem = item.page != 0 ? changeSpans(bytes, spans) : changeItem(item, bytes, spans))
        return problem;
    ++log_->cursor;
    log_->append(item.page != 0 ? dictionary_.addPage(dictionary_.pages().changed(item.where), bytes)
                                : keep(bytes, false, item.model));
    copyBytes(old, bytes);
    return nullptr;
}

// Calls `change(where, words)` for each span. Returns an error if the bytes have fewer words.
template <class Reader, class Change>
DeltaDecoder::Problem DeltaDecoder::eachSpan(Reader& reader, std::span<std::byte> bytes, uint32_t spans,
                                             Change&& change) {
    uint64_t at = 0;
    for (; spans > 0; --spans) {
        uint32_t unchanged = 0, changed = 0;
        reader.span(unchanged, changed);
        if (reader.bad()) return "fewer spans than announced";
        at += uint64_t{unchanged} * 4;
        const uint64_t sizeBytes = uint64_t{changed} * 4;
        if (at + sizeBytes > bytes.size()) return "a delta beyond the end of its entry";
        if (!change(at, bytes.subspan(at, sizeBytes))) return "fewer words than announced";
        at += sizeBytes;
    }
    return nullptr;
}

DeltaDecoder::Problem DeltaDecoder::changeItem(DictionaryEntry& item, std::span<std::byte> bytes, uint32_t spans) {
    words_.begin(item, bytes);
    const Problem problem = eachSpan(control_, bytes, spans, [this](size_t at, std::span<std::byte> words) {
        changeWords(at, words);
        return true;
    });
    if (!problem) words_.end();
    return problem;
}

void DeltaDecoder::changeWords(size_t at, std::span<std::byte> words) {
    for (size_t i = 0; i < words.size(); i += 4) {
        uint32_t word = 0;
        std::memcpy(&word, words.data() + i, 4);
        word = words_.code(coder_, static_cast<uint32_t>((at + i) / 4), word, 0);
        std::memcpy(words.data() + i, &word, 4);
    }
}

DeltaDecoder::Problem DeltaDecoder::fresh(uint32_t sizeBytes, bool page) {
    std::span<const std::byte> bytes;
    if (!room(sizeBytes)) return "the packet or batch is too large";
    if (!take(page ? Section::Pages : Section::Texts, sizeBytes, bytes)) return "fewer bytes than announced";
    const DictionaryEntry item = keep(put(bytes), page);
    log_->replaces(item);
    log_->append(item);
    return nullptr;
}

DeltaDecoder::Problem DeltaDecoder::pages(uint32_t n) {
    const uint32_t from = control_.number();
    for (uint32_t i = 0; i < n; ++i) {
        const uint64_t slot = uint64_t{from} + i;
        const auto page = slot < dictionary_.pages().slots() ? dictionary_.pages().at(static_cast<uint32_t>(slot))
                                                             : std::span<const std::byte>();
        if (page.empty()) return "a reference to an unknown page";
        if (!room(page.size())) return "the packet or batch is too large";
        put(page);
        const DictionaryEntry item =
            dictionary_.fromStore(static_cast<uint32_t>(slot), static_cast<uint32_t>(page.size()));
        log_->replaces(item);
        log_->append(item);
    }
    return nullptr;
}

DeltaDecoder::Problem DeltaDecoder::other(uint32_t n) {
    switch (static_cast<ControlOp>(n)) {
    case ControlOp::End:
        if (!log_) (void)dictionary_.open(stream_); // same order as in the encoder
        ended_ = true;
        return nullptr;
    case ControlOp::Done:
        if (log_ || packetBytes_ > 0) return "an end within a packet";
        done_ = true;
        return nullptr;
    case ControlOp::Stream:
        if (log_) return "another stream within a packet";
        stream_ = control_.number();
        return nullptr;
    case ControlOp::Bytes: return plain({});
    case ControlOp::CachedBytes: return plain(control_.number());
    case ControlOp::ChangedBytes: return changedRun(control_.number());
    }
    return "an unknown control byte";
}

DeltaDecoder::Problem DeltaDecoder::plain(std::optional<uint32_t> slot) {
    const uint32_t sizeBytes = control_.number();
    std::span<const std::byte> bytes;
    if (!room(sizeBytes)) return "the packet or batch is too large";
    if (!take(Section::Texts, sizeBytes, bytes)) return "fewer bytes than announced";
    put(bytes);
    if (!slot) return nullptr;
    if (*slot >= RawRunCache::kSlots || sizeBytes > RawRunCache::kMaxBytes) return "a run of records without its owner";
    dictionary_.runs().keep(*slot, bytes);
    return nullptr;
}

DeltaDecoder::Problem DeltaDecoder::changedRun(uint32_t slot) {
    const uint32_t spans = control_.number();
    const auto unchanged = slot < RawRunCache::kSlots ? dictionary_.runs().at(slot) : std::span<std::byte>();
    if (unchanged.empty()) return "a delta of an unknown run of records";
    if (!room(unchanged.size())) return "the packet or batch is too large";
    std::vector<std::byte> old;
    if (loseWords_) old.assign(unchanged.begin(), unchanged.end());
    if (const Problem problem = changeSpans(unchanged, spans)) return problem;
    loseChanges(old, put(unchanged));
    return nullptr;
}

// Fault injection: GL commands of the run keep their contents in `old`, unless that is empty.
void DeltaDecoder::loseChanges(std::span<const std::byte> old, std::span<std::byte> run) {
    for (size_t at = 0; at + 4 <= old.size();) {
        uint32_t head = 0;
        std::memcpy(&head, run.data() + at, sizeof head);
        const size_t sizeBytes = size_t{head >> 16} * 4;
        if (sizeBytes == 0 || sizeBytes > run.size() - at) return;
        if ((head & 0xffff) >= wire::kFirstGlOpcode && std::memcmp(old.data() + at, &head, sizeof head) == 0)
            copyBytes(old.subspan(at, sizeBytes), run.subspan(at, sizeBytes));
        at += sizeBytes;
    }
}

// Changes words of these bytes by spans outside of Control.
DeltaDecoder::Problem DeltaDecoder::changeSpans(std::span<std::byte> bytes, uint32_t spans) {
    return eachSpan(spans_, bytes, spans, [this](size_t, std::span<std::byte> words) {
        std::span<const std::byte> now;
        if (!take(Section::Words, words.size(), now)) return false;
        copyBytes(now, words);
        return true;
    });
}

DictionaryEntry DeltaDecoder::keep(std::span<const std::byte> bytes, bool page, uint32_t model) {
    return page ? dictionary_.addPage(dictionary_.pages().take(), bytes) : dictionary_.addText(bytes, model);
}

bool DeltaDecoder::take(Section section, size_t sizeBytes, std::span<const std::byte>& into) {
    auto& left = sections_[static_cast<size_t>(section)];
    if (left.size() < sizeBytes) return false;
    into = left.first(sizeBytes);
    left = left.subspan(sizeBytes);
    return true;
}

bool DeltaDecoder::room(size_t sizeBytes) {
    batchBytes_ += sizeBytes;
    return sizeBytes <= wire::kMaxPacketBytes - packetBytes_ && batchBytes_ <= kMaxBatchBytes;
}

std::span<std::byte> DeltaDecoder::put(std::span<const std::byte> bytes) {
    const auto into = std::span(packet_.get() + packetBytes_, bytes.size());
    if (!bytes.empty()) std::memcpy(into.data(), bytes.data(), bytes.size());
    packetBytes_ += bytes.size();
    return into;
}

} // namespace mural::delta
