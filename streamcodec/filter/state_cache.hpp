// Cache of state cells, each set completely by one command. Stores, per cell, the value that the nodes have and the
// deferred value. Values are whole records, so equality covers the command and all arguments.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace mural::filter {

// Disposition of a record that sets a cell.
enum class Disposition : uint8_t { Goes, Waits, LeftOut };
struct SetResult {
    Disposition fate = Disposition::Goes;
    uint32_t gone = 0; // number of records dropped: this one, the deferred one, or both
    size_t goneBytes = 0;
};

// Words: length of the longest record.
template <size_t Words> class StateCache {
public:
    static constexpr size_t kMaxBytes = Words * 4;

    // Sets a cell. A `deferrable` command waits until a command reads the cell. Any other command goes now, unless it
    // is redundant. A later command replaces a deferred one. The caller guarantees that both are valid or both invalid.
    SetResult set(size_t index, std::span<const std::byte> record, bool deferrable) {
        if (index >= cells_.size()) cells_.resize(index + 1);
        Cell& cell = cells_[index];
        SetResult outcome{deferrable ? Disposition::Waits : Disposition::Goes, 0, 0};
        if (cell.waits) {
            outcome = {Disposition::Waits, 1, cell.now.sizeBytes};
            waitingBytes_ -= cell.now.sizeBytes;
        }
        if (cell.generation == generation_ && cell.sent == record) {
            if (cell.waits) std::erase(order_, index);
            cell.waits = false;
            return {Disposition::LeftOut, outcome.gone + 1, outcome.goneBytes + record.size()};
        }
        if (outcome.fate == Disposition::Goes) {
            cell.sent = record;
            cell.generation = generation_;
            return outcome;
        }
        cell.now = record;
        waitingBytes_ += record.size();
        if (!cell.waits) order_.push_back(static_cast<uint32_t>(index));
        cell.waits = true;
        return outcome;
    }

    // Returns true if the deferred record is of another command that sets the same cell.
    [[nodiscard]] bool otherWaits(size_t index, std::span<const std::byte> record) const {
        return index < cells_.size() && cells_[index].waits &&
               (cells_[index].now.sizeBytes != record.size() ||
                std::memcmp(cells_[index].now.words.data(), record.data(), 4) != 0);
    }
    [[nodiscard]] bool waiting() const { return !order_.empty(); }
    [[nodiscard]] size_t waitingRecords() const { return order_.size(); }
    [[nodiscard]] size_t waitingBytes() const { return waitingBytes_; }

    // Flushes the deferred records in order, by passing each to `give`.
    template <typename Give> void send(const Give& give) {
        for (const uint32_t index : order_) {
            Cell& cell = cells_[index];
            give(cell.now.bytes());
            cell.sent = cell.now;
            cell.generation = generation_;
            cell.waits = false;
        }
        order_.clear();
        waitingBytes_ = 0;
    }
    // Marks the nodes' value as unknown. Requires that nothing is deferred.
    void forget(size_t index) {
        if (index < cells_.size()) cells_[index].generation = generation_ - 1;
    }
    void forgetAll() { ++generation_; }

private:
    struct Record {
        uint32_t sizeBytes = 0;
        std::array<uint32_t, Words> words;
        Record& operator=(std::span<const std::byte> record) {
            sizeBytes = static_cast<uint32_t>(record.size());
            std::memcpy(words.data(), record.data(), record.size());
            return *this;
        }
        bool operator==(std::span<const std::byte> record) const {
            return sizeBytes == record.size() && std::memcmp(words.data(), record.data(), sizeBytes) == 0;
        }
        [[nodiscard]] std::span<const std::byte> bytes() const {
            return std::as_bytes(std::span(words)).first(sizeBytes);
        }
    };
    struct Cell {
        bool waits = false;
        uint32_t generation = 0; // generation in which `sent` is valid
        Record now, sent;
    };

    std::vector<Cell> cells_;
    std::vector<uint32_t> order_; // order of the deferred cells
    uint32_t generation_ = 1;
    size_t waitingBytes_ = 0;
};

} // namespace mural::filter
