// Accelerates the walk over repeated record sequences (rounds), such as a normal and four vertices. A serial walk knows
// the start of a record only after the previous one, 2 ns each. While a round has the same headers as the previous
// round, its records have the same offsets and are read in parallel (0.3 ns each, with seven per round).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace mural {

// Finds rounds. The walk over short records reports each record with add(). A round lies between two places with the
// same pair of headers. One header does not identify a place, because it occurs several times in most rounds.
class RecordRound {
public:
    // Returns whether a record with this header may start a new round.
    [[nodiscard]] bool closes(uint32_t head) {
        if (count_ < 2) return false;
        const uint32_t back = static_cast<uint8_t>(count_ - last_[pairOf(before(1), head)]);
        if (back - 1 >= kMax || back >= count_ || before(back) != head || before(back + 1) != before(1)) return false;
        size_ = back;
        if (wait_ == 0) return true;
        --wait_;
        return false;
    }
    // Skips whole rounds equal to the last one, from the record at `at`, which starts a round. Returns their number. If
    // it is 0, continue with add().
    [[nodiscard]] size_t pass(std::span<const std::byte> packet, size_t& at) {
        const size_t start = positions_[(count_ - size_) % kHistory];
        for (size_t i = 0; i < size_; ++i) {
            round_[i] = before(size_ - i);
            offsets_[i] = positions_[(count_ - size_ + i) % kHistory] - start;
        }
        const size_t sizeBytes = at - start, rounds = roundsAt(packet.subspan(at), sizeBytes);
        // Exponential backoff where rounds rarely repeat.
        patience_ = rounds > 0 ? 0 : std::min(2 * patience_ + 1, kMaxPatience);
        wait_ = patience_;
        // The skipped rounds may be part of a longer round.
        const size_t stored = std::min(rounds, (kMax + size_ - 1) / size_);
        at += (rounds - stored) * sizeBytes;
        for (size_t i = 0; i < stored; ++i, at += sizeBytes)
            for (size_t k = 0; k < size_; ++k) add(round_[k], at + offsets_[k]);
        return rounds;
    }
    void begin() { count_ = 0; }
    void add(uint32_t head, size_t at) {
        if (count_ > 0) last_[pairOf(before(1), head)] = static_cast<uint8_t>(count_);
        heads_[count_ % kHistory] = head;
        positions_[count_ % kHistory] = at;
        ++count_;
    }

    [[nodiscard]] size_t size() const { return size_; } // records per skipped round
    [[nodiscard]] uint32_t head(size_t i) const { return round_[i]; }

private:
    static constexpr size_t kMax = 16, kHistory = 32;
    static constexpr uint32_t kMaxPatience = 127;
    static constexpr size_t kPairs = 64;

    [[nodiscard]] uint32_t before(size_t records) const { return heads_[(count_ - records) % kHistory]; }
    static size_t pairOf(uint32_t first, uint32_t second) { return ((first * 5 + second) * 0x9e3779b1u) >> 26; }

    // Most rounds have few records. With a compile-time size, headers and offsets stay in registers.
    [[nodiscard]] size_t roundsAt(std::span<const std::byte> from, size_t sizeBytes) const {
        switch (size_) {
        case 1: return roundsOf<1>(from, sizeBytes);
        case 2: return roundsOf<2>(from, sizeBytes);
        case 3: return roundsOf<3>(from, sizeBytes);
        case 4: return roundsOf<4>(from, sizeBytes);
        case 5: return roundsOf<5>(from, sizeBytes);
        case 6: return roundsOf<6>(from, sizeBytes);
        case 7: return roundsOf<7>(from, sizeBytes);
        case 10: return roundsOf<10>(from, sizeBytes); // a quad with normals
        default: return roundsOf<0>(from, sizeBytes);
        }
    }
    template <size_t Size> // 0: any size
    [[nodiscard]] size_t roundsOf(std::span<const std::byte> from, size_t sizeBytes) const {
        std::array<uint32_t, Size == 0 ? kMax : Size> heads;
        std::array<size_t, Size == 0 ? kMax : Size> offsets;
        const size_t size = Size == 0 ? size_ : Size;
        std::copy_n(round_.begin(), size, heads.begin());
        std::copy_n(offsets_.begin(), size, offsets.begin());
        size_t rounds = 0;
        for (const std::byte *at = from.data(), *end = at + from.size(); static_cast<size_t>(end - at) >= sizeBytes;
             at += sizeBytes, ++rounds)
            for (size_t i = 0; i < size; ++i) {
                uint32_t head = 0;
                std::memcpy(&head, at + offsets[i], sizeof head);
                if (head != heads[i]) return rounds;
            }
        return rounds;
    }

    std::array<uint8_t, kPairs> last_{}; // number of the last record with this pair of headers; the lower bits suffice
    std::array<uint32_t, kHistory> heads_;   // of the last records, a ring buffer
    std::array<size_t, kHistory> positions_; // bytes
    size_t count_ = 0;
    std::array<uint32_t, kMax> round_;
    std::array<size_t, kMax> offsets_; // bytes from the round's first record
    size_t size_ = 0;
    uint32_t patience_ = 0, wait_ = 0; // round starts to ignore
};

} // namespace mural
