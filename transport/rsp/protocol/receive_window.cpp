#include "transport/rsp/protocol/receive_window.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "common/base/little_endian.hpp"
#include "transport/rsp/erasure/erasure_code.hpp"

namespace mural::rsp {

namespace {

constexpr uint32_t kNoSlot = UINT32_MAX;

// Size of a slot: a whole datagram with any tag, rounded up to cache lines.
constexpr size_t slotBytes(size_t payloadBytes) {
    constexpr size_t kLineBytes = 64;
    const size_t maximum = kStreamHeaderBytes + kLengthBytes + payloadBytes + kMaxTagBytes;
    return (maximum + kLineBytes - 1) / kLineBytes * kLineBytes;
}

} // namespace

ReceiveWindow::ReceiveWindow(const StreamShape& shape, Sequence first)
    : payloadBytes_(shape.payloadBytes),
      mask_(shape.windowDatagrams - 1),
      payloads_(slotBytes(shape.payloadBytes), shape.windowDatagrams + kMaxAtOnce),
      poolSlots_(shape.windowDatagrams),
      lengths_(shape.windowDatagrams),
      groupBases_(shape.windowDatagrams),
      groups_(shape.windowDatagrams),
      known_(shape.windowDatagrams),
      cumulative_(first),
      reading_(first),
      forgotten_(first) {
    landing_.fill(kNoSlot);
}

// The group of `cumulative` is kept whole while its parity may be needed.
Sequence ReceiveWindow::oldest() const {
    if (cumulative_ == forgotten_) return forgotten_;
    const Sequence base = groupBases_[slot(cumulative_ - 1)];
    const Group& g = groups_[slot(base)];
    const bool needed = known_[slot(base)] && g.base == base && !g.complete(); // otherwise it is forgotten or complete
    return earlier(reading_, needed ? base : cumulative_);
}

void ReceiveWindow::forget() {
    for (const Sequence until = oldest(); forgotten_ < until; ++forgotten_) forgetDatagram(slot(forgotten_));
}

void ReceiveWindow::forgetDatagram(size_t at) {
    payloads_.giveBack(poolSlots_[at]); // everything before the oldest has been received
    lengths_[at] = 0;
    if (!known_[at]) return;
    known_[at] = false;
    dropRows(groups_[at]);
    groups_[at] = Group{};
}

void ReceiveWindow::dropRows(Group& g) {
    rowsHeld_ -= g.rows.size();
    g.rows.clear();
}

// Returns null if no group can begin there.
ReceiveWindow::Group* ReceiveWindow::groupAt(Sequence base) {
    if (!inWindow(base)) return nullptr;
    Group& g = groups_[slot(base)];
    if (!known_[slot(base)]) {
        known_[slot(base)] = true;
        g.base = base;
    }
    return &g;
}

bool ReceiveWindow::setGroupSize(Group& g, uint8_t size) {
    if (size == 0 || size == g.size) return true;
    if (g.size != 0 || (size < kMaxInGroup && g.have >> size != 0)) return false;
    g.size = size;
    return true;
}

ReceiveBuffers ReceiveWindow::landing() {
    // Recycle the lowest slots: data read in the meantime has freed slots that are still in the processor's cache.
    for (const uint32_t poolSlot : landing_)
        if (poolSlot != kNoSlot) payloads_.giveBack(poolSlot);
    for (size_t i = 0; i < kMaxAtOnce; ++i) {
        landing_[i] = payloads_.take();
        landingBytes_[i] = payloads_.at(landing_[i]);
    }
    landed_ = 0;
    return {slotBytes(payloadBytes_), landingBytes_};
}

// Returns the slot that already contains the payload, otherwise a slot with a copy.
uint32_t ReceiveWindow::slotFor(std::span<const std::byte> payload) {
    const auto isAt = [&](size_t i) {
        return landing_[i] != kNoSlot && landingBytes_[i] + kStreamHeaderBytes == payload.data();
    };
    for (size_t k = 0; k < kMaxAtOnce; ++k) { // usually the next one
        const size_t i = (landed_ + k) % kMaxAtOnce;
        if (!isAt(i)) continue;
        landed_ = i + 1;
        return std::exchange(landing_[i], kNoSlot);
    }
    const uint32_t poolSlot = payloads_.take();
    std::memcpy(payloads_.at(poolSlot) + kStreamHeaderBytes, payload.data(), payload.size());
    return poolSlot;
}

void ReceiveWindow::store(Group& g, Sequence s, std::span<const std::byte> payload) {
    poolSlots_[slot(s)] = slotFor(payload);
    lengths_[slot(s)] = static_cast<uint16_t>(payload.size());
    groupBases_[slot(s)] = g.base;
    g.have |= 1u << (s - g.base);
}

ReceiveWindow::InsertResult ReceiveWindow::takeData(const StreamDatagram& d) {
    if (has(d.sequence)) {
        ++counters_.duplicates;
        // May reveal the size of an open group.
        if (d.groupSize != 0) updateGroupSize(d.groupBase(), d.groupSize);
        return InsertResult::Known;
    }
    if (!inWindow(d.sequence)) {
        ++counters_.outside;
        return InsertResult::Refused;
    }
    Group* g = groupAt(d.groupBase());
    if (!g || d.payload.size() > payloadBytes_ || !setGroupSize(*g, d.groupSize) ||
        (g->size != 0 && d.index >= g->size)) {
        ++counters_.refused;
        return InsertResult::Refused;
    }
    ++counters_.datagrams;
    store(*g, d.sequence, d.payload);
    tryToComplete(*g);
    advance();
    return InsertResult::New;
}

ReceiveWindow::InsertResult ReceiveWindow::takeParity(const StreamDatagram& d) {
    if (d.sequence < forgotten_) {
        ++counters_.duplicates;
        return InsertResult::Known;
    }
    Group* g = groupAt(d.sequence);
    const size_t bytes = d.payload.size();
    if (!g || bytes > payloadBytes_ + kLengthBytes || !setGroupSize(*g, d.groupSize)) {
        ++(g ? counters_.refused : counters_.outside);
        return InsertResult::Refused;
    }
    const auto sameRow = [&](const Row& r) { return r.row == d.row; };
    if (g->missing() == 0 || std::ranges::any_of(g->rows, sameRow)) {
        ++counters_.duplicates;
        tryToComplete(*g); // its size may be new
        advance();
        return InsertResult::Known;
    }
    if ((!g->rows.empty() && g->rows[0].symbol.size() != bytes) || rowsHeld_ > mask_) {
        ++counters_.refused;
        return InsertResult::Refused;
    }
    ++counters_.datagrams;
    ++rowsHeld_;
    g->rows.push_back({d.row, {d.payload.begin(), d.payload.end()}});
    tryToComplete(*g);
    advance();
    return InsertResult::New;
}

void ReceiveWindow::updateGroupSize(Sequence base, uint8_t size) {
    if (size == 0 || !inWindow(base)) return;
    Group* g = groupAt(base);
    if (!g || !setGroupSize(*g, size)) {
        ++counters_.refused;
        return;
    }
    tryToComplete(*g);
    advance();
}

void ReceiveWindow::tryToComplete(Group& g) {
    if (g.size == 0 || g.rows.empty()) return;
    const uint32_t missing = g.missing();
    if (missing == 0) return dropRows(g);
    const auto count = static_cast<size_t>(std::popcount(missing));
    if (count > g.rows.size()) return;
    std::array<int, kMaxInGroup> indices{};
    size_t n = 0;
    for (uint32_t left = missing; left != 0; left &= left - 1) indices[n++] = std::countr_zero(left);
    recover(g, std::span(indices).first(count));
    dropRows(g);
}

// Turns a parity symbol of all symbols into one of the missing ones.
bool ReceiveWindow::addPresent(const Group& g, Row& row) const {
    for (uint32_t left = g.have; left != 0; left &= left - 1) {
        const int index = std::countr_zero(left);
        const auto present = payload(g.base + index);
        if (present.size() + kLengthBytes > row.symbol.size()) return false;
        addSymbol(row.symbol, row.row, index, present);
    }
    return true;
}

bool ReceiveWindow::takeSymbol(Group& g, int index, std::span<const std::byte> symbol) {
    const size_t bytes = loadLittle<uint16_t>(symbol.data());
    const Sequence s = g.base + index;
    if (bytes == 0 || bytes > payloadBytes_ || bytes + kLengthBytes > symbol.size() || !inWindow(s) || has(s))
        return false;
    store(g, s, symbol.subspan(kLengthBytes, bytes));
    return true;
}

void ReceiveWindow::recover(Group& g, std::span<const int> missing) {
    std::array<HeldRow, kMaxInGroup> rows{};
    for (size_t i = 0; i < missing.size(); ++i) {
        if (!addPresent(g, g.rows[i])) {
            ++counters_.refused;
            return;
        }
        rows[i] = {g.rows[i].row, g.rows[i].symbol};
    }
    solveMissing(missing, std::span(rows).first(missing.size()), scratch_);
    for (size_t i = 0; i < missing.size(); ++i) {
        if (takeSymbol(g, missing[i], rows[i].symbol))
            ++counters_.recovered;
        else
            ++counters_.refused;
    }
}

void ReceiveWindow::advance() {
    while (inWindow(cumulative_) && lengths_[slot(cumulative_)] != 0) ++cumulative_;
    if (forgotten_ < reading_) forget(); // nothing before it is unread
}

std::span<const std::byte> ReceiveWindow::readable() const {
    if (reading_ == cumulative_) return {};
    return payload(reading_).subspan(readBytes_);
}

size_t ReceiveWindow::readable(std::span<std::span<const std::byte>> into) const {
    const auto count = std::min(into.size(), static_cast<size_t>(cumulative_ - reading_));
    for (size_t i = 0; i < count; ++i) into[i] = payload(reading_ + static_cast<int64_t>(i));
    if (count > 0) into[0] = into[0].subspan(readBytes_);
    return count;
}

void ReceiveWindow::consume(size_t bytes) {
    while (bytes > 0) {
        const size_t count = std::min(bytes, lengths_[slot(reading_)] - readBytes_);
        bytes -= count;
        readBytes_ += count;
        if (readBytes_ < lengths_[slot(reading_)]) return;
        readBytes_ = 0;
        ++reading_;
    }
    forget();
}

const ReceiveWindow::Group* ReceiveWindow::findGroup(Sequence s) const {
    for (int i = 0; i < kMaxInGroup && inWindow(s - i); ++i) {
        const Group& g = groups_[slot(s - i)];
        if (!known_[slot(s - i)]) continue;
        return g.size == 0 || i < g.size ? &g : nullptr;
    }
    return nullptr;
}

Missing ReceiveWindow::missingFrom(Sequence from, Sequence until) const {
    Sequence s = from;
    while (s < until && has(s)) ++s;
    if (s >= until) return {};
    Missing m;
    const Group* g = findGroup(s);
    m.base = g ? g->base : s;
    const int64_t maximum = std::min<int64_t>(kMaxInGroup, until - m.base);
    int64_t span = g && g->size != 0 ? std::min<int64_t>(g->size, maximum) : maximum;
    for (int64_t i = s - m.base; i < span; ++i) {
        const Sequence at = m.base + i;
        // Another group begins here, so the unknown one ends.
        if (at != m.base && inWindow(at) && known_[slot(at)])
            span = i;
        else if (!has(at))
            m.missing |= 1u << i;
    }
    m.span = static_cast<uint8_t>(span);
    m.rows = g ? static_cast<uint8_t>(std::min<size_t>(255, g->rows.size())) : 0;
    return m;
}

} // namespace mural::rsp
