// The dictionary: everything that both sides remember. Encoder and decoder apply the same operations in the same order,
// so a reference is a position in it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "streamcodec/delta/dictionary/dictionary_entry.hpp"
#include "streamcodec/delta/dictionary/entry_log.hpp"
#include "streamcodec/delta/dictionary/raw_run_cache.hpp"
#include "streamcodec/delta/limits.hpp"
#include "streamcodec/delta/dictionary/page_store.hpp"
#include "streamcodec/delta/dictionary/record_ring.hpp"

namespace mural::delta {

class Dictionary {
public:
    explicit Dictionary(const Limits& limits)
        : limits_(limits),
          text_(limits.textBytes),
          pages_(limits.cacheBytes),
          first_(std::make_unique<EntryLog>(limits.logItems)) {}

    [[nodiscard]] bool ready() const { return pages_.ready(); }

    [[nodiscard]] std::span<const std::byte> bytesOf(DictionaryEntry item) const {
        return item.page ? pages_.bytes(item.where, item.sizeBytes) : text_.at(item.where, item.sizeBytes);
    }
    // Repeats the given number of entries of a log from its cursor on. Requires that none of them is old.
    void againAll(EntryLog& log, size_t items) {
        log.appendCopies(log.cursor, items);
        log.cursor += items;
    }
    // The longest run of short entries after the cursor whose bytes are contiguous and not old. Bytes are contiguous if
    // the entries were added in this order.
    struct Stretch {
        std::span<const std::byte> bytes;
        size_t items = 0;
    };
    [[nodiscard]] Stretch stretch(const EntryLog& log, size_t maxItems) const {
        size_t items = 0, sizeBytes = 0;
        const uint32_t where = log.at(log.cursor).where;
        for (const auto maximum = static_cast<size_t>(std::min<uint64_t>(maxItems, log.end() - log.cursor));
             items < maximum; ++items) {
            const DictionaryEntry item = log.at(log.cursor + items);
            if (item.page || item.where != where + sizeBytes || text_.old(item.where)) break;
            sizeBytes += item.sizeBytes;
        }
        return {items > 0 ? text_.at(where, sizeBytes) : std::span<const std::byte>(), items};
    }
    [[nodiscard]] const RecordRing& text() const { return text_; }
    // Returns the repeated entry as its log stores it.
    [[nodiscard]] DictionaryEntry again(DictionaryEntry item) {
        if (item.page)
            pages_.use(item.where);
        else if (text_.old(item.where))
            item.where = text_.add(text_.at(item.where, item.sizeBytes));
        return item;
    }
    // Returns an entry for a stored page that takes another page's place.
    [[nodiscard]] DictionaryEntry fromStore(uint32_t slot, uint32_t sizeBytes) {
        pages_.useElsewhere(slot);
        return {slot, sizeBytes, 1};
    }
    [[nodiscard]] DictionaryEntry addText(std::span<const std::byte> bytes, uint32_t model) {
        return {text_.add(bytes), static_cast<uint32_t>(bytes.size()), 0, model};
    }
    [[nodiscard]] DictionaryEntry addPage(uint32_t slot, std::span<const std::byte> bytes) {
        pages_.fill(slot, bytes);
        return {slot, static_cast<uint32_t>(bytes.size()), 1, 0};
    }
    [[nodiscard]] PageStore& pages() { return pages_; }
    [[nodiscard]] RawRunCache& runs() { return runs_; }

    // Opens the log of a stream. A new stream takes over the least recently used log.
    struct Opened {
        size_t logIndex = 0;
        bool fresh = false; // the log is empty
    };
    [[nodiscard]] Opened open(uint32_t stream);
    [[nodiscard]] EntryLog& log(size_t logIndex) { return *streams_[logIndex].log; }

private:
    struct Stream {
        uint32_t stream = 0;
        uint64_t usedAt = 0;
        std::unique_ptr<EntryLog> log;
    };
    const Limits limits_;
    RecordRing text_;
    PageStore pages_;
    RawRunCache runs_;
    std::vector<Stream> streams_;
    std::unique_ptr<EntryLog> first_; // allocated in advance for the first stream
    uint64_t opened_ = 0;
};

} // namespace mural::delta
