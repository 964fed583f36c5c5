// The same few commands again and again: a normal and four vertices, a colour and a point. Where a record begins is known only when
// the one before it has been read, 2.7 ns for each; while the records of a round have the heads of the round before, they lie where
// those did, and are read beside each other (0.6 ns, seven in a round).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace mural {

// Of a walk over short records, which tells of each that it passes one by one.
class RecordRound {
public:
    // A record with this head begins a round anew, maybe.
    [[nodiscard]] bool closes(uint32_t head) {
        if (size_ == 0 || head != heads_[0]) return false;
        if (wait_ == 0) return true;
        --wait_;
        begin();
        return false;
    }
    // On over whole rounds like the last one, from the record at `at`, which closes it. How many there were; see head().
    [[nodiscard]] size_t pass(std::span<const std::byte> packet, size_t& at) {
        const size_t sizeBytes = at - start_, rounds = roundsAt(packet.subspan(at), sizeBytes);
        at += rounds * sizeBytes;
        // Where rounds seldom repeat, that is tried the seldomer.
        patience_ = rounds > 0 ? 0 : std::min(2 * patience_ + 1, kMostPatience);
        wait_ = patience_;
        return rounds;
    }
    void begin() { size_ = 0; }
    void add(uint32_t head, size_t at) {
        if (size_ == kMost) begin();
        if (size_ == 0) start_ = at;
        heads_[size_] = head;
        places_[size_++] = at - start_;
    }

    [[nodiscard]] size_t size() const { return size_; } // records in a round
    [[nodiscard]] uint32_t head(size_t i) const { return heads_[i]; }

private:
    static constexpr size_t kMost = 16;
    static constexpr uint32_t kMostPatience = 127;

    // Most rounds are of few records: of so many as are known when this is compiled heads and places stay in registers.
    [[nodiscard]] size_t roundsAt(std::span<const std::byte> from, size_t sizeBytes) const {
        switch (size_) {
        case 1: return roundsOf<1>(from, sizeBytes);
        case 2: return roundsOf<2>(from, sizeBytes);
        case 3: return roundsOf<3>(from, sizeBytes);
        case 4: return roundsOf<4>(from, sizeBytes);
        default: return roundsOf<0>(from, sizeBytes);
        }
    }
    template <size_t Size> // 0: any
    [[nodiscard]] size_t roundsOf(std::span<const std::byte> from, size_t sizeBytes) const {
        std::array<uint32_t, Size == 0 ? kMost : Size> heads;
        std::array<size_t, Size == 0 ? kMost : Size> places;
        const size_t size = Size == 0 ? size_ : Size;
        std::copy_n(heads_.begin(), size, heads.begin());
        std::copy_n(places_.begin(), size, places.begin());
        size_t rounds = 0;
        for (const std::byte *at = from.data(), *end = at + from.size(); static_cast<size_t>(end - at) >= sizeBytes; at += sizeBytes, ++rounds)
            for (size_t i = 0; i < size; ++i) {
                uint32_t head = 0;
                std::memcpy(&head, at + places[i], sizeof head);
                if (head != heads[i]) return rounds;
            }
        return rounds;
    }

    std::array<uint32_t, kMost> heads_;
    std::array<size_t, kMost> places_; // bytes from the first
    size_t size_ = 0, start_ = 0;
    uint32_t patience_ = 0, wait_ = 0; // closings that are not looked at
};

} // namespace mural
