#include "economy/unpacker.hpp"

#include <cstring>

#include "streamcodec/wire.hpp"

namespace mural::economy {

namespace {

uint32_t opcodeOf(std::span<const std::byte> record) {
    uint32_t head = 0;
    if (record.size() >= sizeof head) std::memcpy(&head, record.data(), sizeof head);
    return head & 0xffff;
}

} // namespace

Unpacker::Unpacker(const Limits& limits) : history_(limits), packet_(std::make_unique_for_overwrite<std::byte[]>(wire::kMaxPacketBytes)) {}

void Unpacker::begin(const SectionBytes& sections) {
    sections_ = sections;
    control_ = ControlReader(sections[static_cast<size_t>(Section::Control)]);
    batchBytes_ = 0;
}

Result<bool> Unpacker::next(uint32_t& stream, std::span<const std::byte>& packet) {
    if (control_.atEnd()) return false;
    packetBytes_ = 0;
    log_ = nullptr;
    for (ended_ = false; !ended_;) {
        uint32_t n = 0;
        const Do what = control_.what(n);
        Problem problem = control_.bad() ? nullptr : step(what, n);
        if (control_.bad()) problem = "its control bytes end in the middle of a packet";
        if (problem) return Error{std::string("the head's stream can't be unpacked: ") + problem + "; head and nodes must be of one build"};
    }
    stream = stream_;
    packet = {packet_.get(), packetBytes_};
    return true;
}

Unpacker::Problem Unpacker::step(Do what, uint32_t n) {
    if (what == Do::Other) return other(n);
    if (!log_) log_ = &history_.log(history_.open(stream_).place);
    switch (what) {
    case Do::Run: return run(n);
    case Do::Patch: return patch(n);
    case Do::NewText: return n >= 1 && n <= kMostTextBytes / 4 ? fresh(n * 4, false) : "a new text of an impossible size";
    case Do::NewPage: return n == 0 || (n > kMostTextBytes / 4 && n < kPageBytes / 4) ? fresh(n == 0 ? kPageBytes : n * 4, true) : "a new page of an impossible size";
    case Do::Skip: log_->cursor += n; return nullptr;
    case Do::Seek:
        if (n == 0 || n > log_->end()) return "a place before the first item";
        log_->cursor = log_->end() - n;
        return nullptr;
    case Do::Pages: return pages(n);
    case Do::Other: break;
    }
    return "an unknown control byte";
}

Unpacker::Problem Unpacker::run(uint32_t n) {
    for (; n > 0; --n) {
        if (!log_->holds(log_->cursor)) return "an item that is not remembered";
        const Item item = log_->at(log_->cursor);
        if (!room(item.sizeBytes)) return "a packet or batch that is too large";
        put(history_.bytesOf(item));
        ++log_->cursor;
        log_->append(history_.again(item));
    }
    return nullptr;
}

Unpacker::Problem Unpacker::patch(uint32_t spans) {
    if (!log_->holds(log_->cursor)) return "a change of an item that is not remembered";
    const Item item = log_->at(log_->cursor);
    if (!room(item.sizeBytes)) return "a packet or batch that is too large";
    const auto bytes = put(history_.bytesOf(item));
    const bool lost = loseWords_ && opcodeOf(bytes) >= wire::kFirstGlOpcode;
    uint64_t at = 0;
    for (; spans > 0; --spans) {
        uint32_t kept = 0, changed = 0;
        control_.span(kept, changed);
        at += uint64_t{kept} * 4;
        std::span<const std::byte> words;
        if (at + uint64_t{changed} * 4 > bytes.size()) return "a change behind the end of an item";
        if (!take(Section::Words, size_t{changed} * 4, words)) return "fewer words than it names";
        if (!lost) std::memcpy(bytes.data() + at, words.data(), words.size());
        at += words.size();
    }
    ++log_->cursor;
    log_->append(keep(bytes, item.page != 0));
    return nullptr;
}

Unpacker::Problem Unpacker::fresh(uint32_t sizeBytes, bool page) {
    std::span<const std::byte> bytes;
    if (!room(sizeBytes)) return "a packet or batch that is too large";
    if (!take(page ? Section::Pages : Section::Texts, sizeBytes, bytes)) return "fewer bytes than it names";
    const Item item = keep(put(bytes), page);
    log_->replaces(item);
    log_->append(item);
    return nullptr;
}

Unpacker::Problem Unpacker::pages(uint32_t n) {
    const uint32_t from = control_.number();
    for (uint32_t i = 0; i < n; ++i) {
        const uint64_t slot = uint64_t{from} + i;
        const auto page = slot < history_.pages().slots() ? history_.pages().at(static_cast<uint32_t>(slot)) : std::span<const std::byte>();
        if (page.empty()) return "a page that is not in the store";
        if (!room(page.size())) return "a packet or batch that is too large";
        put(page);
        const Item item = history_.again({static_cast<uint32_t>(slot), static_cast<uint32_t>(page.size()), 1});
        log_->replaces(item);
        log_->append(item);
    }
    return nullptr;
}

Unpacker::Problem Unpacker::other(uint32_t n) {
    switch (static_cast<Other>(n)) {
    case Other::End:
        if (!log_) (void)history_.open(stream_); // as the packer did
        ended_ = true;
        return nullptr;
    case Other::Stream:
        if (log_) return "another stream in the middle of a packet";
        stream_ = control_.number();
        return nullptr;
    case Other::Bytes: {
        const uint32_t sizeBytes = control_.number();
        std::span<const std::byte> bytes;
        if (!room(sizeBytes)) return "a packet or batch that is too large";
        if (!take(Section::Texts, sizeBytes, bytes)) return "fewer bytes than it names";
        put(bytes);
        return nullptr;
    }
    }
    return "an unknown control byte";
}

Item Unpacker::keep(std::span<const std::byte> bytes, bool page) {
    return page ? history_.addPage(history_.pages().take(), bytes) : history_.addText(bytes);
}

bool Unpacker::take(Section section, size_t sizeBytes, std::span<const std::byte>& into) {
    auto& left = sections_[static_cast<size_t>(section)];
    if (left.size() < sizeBytes) return false;
    into = left.first(sizeBytes);
    left = left.subspan(sizeBytes);
    return true;
}

bool Unpacker::room(size_t sizeBytes) {
    batchBytes_ += sizeBytes;
    return sizeBytes <= wire::kMaxPacketBytes - packetBytes_ && batchBytes_ <= kMostBatchBytes;
}

std::span<std::byte> Unpacker::put(std::span<const std::byte> bytes) {
    const auto into = std::span(packet_.get() + packetBytes_, bytes.size());
    if (!bytes.empty()) std::memcpy(into.data(), bytes.data(), bytes.size());
    packetBytes_ += bytes.size();
    return into;
}

} // namespace mural::economy
