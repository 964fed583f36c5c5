// Encoder of the head: replaces packets by references to the dictionary and new data. One encoder serves all nodes,
// which receive the same stream. Linear in the packet size. Not thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "streamcodec/delta/batch.hpp"
#include "streamcodec/delta/control_code.hpp"
#include "streamcodec/delta/section_buffer.hpp"
#include "streamcodec/delta/dictionary/dictionary.hpp"
#include "streamcodec/delta/match_index.hpp"
#include "streamcodec/delta/run_cache.hpp"
#include "streamcodec/delta/novelty_detector.hpp"
#include "streamcodec/delta/packet_cut.hpp"
#include "streamcodec/delta/page_index.hpp"
#include "streamcodec/delta/raw_run_slots.hpp"
#include "streamcodec/delta/entropy/word_predictor.hpp"
#include "streamcodec/delta/entropy/word_patch.hpp"
#include "streamcodec/wire/record_offsets.hpp"

namespace mural::delta {

// Totals since the start.
struct DeltaEncoderCounts {
    uint64_t packets = 0;
    uint64_t records = 0;
    uint64_t rawBytes = 0;
    uint64_t stagedBytes = 0; // after delta coding, before compression
    uint64_t pageHits = 0;    // pages that the nodes had
    uint64_t newPages = 0;    // pages that the nodes did not have
    uint64_t patches = 0;     // entries sent as changed words
};

class DeltaEncoder {
public:
    explicit DeltaEncoder(const Limits& limits)
        : limits_(limits),
          dictionary_(limits),
          firstIndex_(std::make_unique<StreamIndex>(limits.logItems)),
          words_(limits.modelWords) {}

    // Returns false if there was no memory for the store.
    [[nodiscard]] bool ready() const { return dictionary_.ready(); }

    // Adds a packet, which must stay valid until clear() or ownBytes(). walked: record offsets of the packet, if known;
    // they save a second walk over plain records.
    void add(uint32_t stream, std::span<const std::byte> packet, const RecordOffsets* walked = nullptr);
    // Copies borrowed bytes: added packets may become invalid afterwards.
    void ownBytes() { literals_[static_cast<size_t>(Section::Texts)].own(); }

    // Begins another frame, or continues a long one. plain: short records are sent plain. Call between batches only.
    void beginFrame(bool plain, bool goesOn = false) {
        plain_ = plain;
        frames_ += !goesOn;
    }
    [[nodiscard]] bool plain() const { return plain_; }

    // Returns the batch since clear(). Call clear() next.
    [[nodiscard]] SectionBytes finish();
    [[nodiscard]] uint64_t stagedBytes() const;
    [[nodiscard]] uint64_t rawBytes() const { return batchRawBytes_; }
    [[nodiscard]] uint64_t pageBytes() const { return batchPageBytes_; } // in pages of long records
    // Bytes in short records that were sent plain because they followed many new ones.
    [[nodiscard]] uint64_t droppedBytes() const { return batchDroppedBytes_; }
    void clear();
    // Returns true if the last packet ends within a blob. Nodes cannot act on an incomplete blob.
    [[nodiscard]] bool endsInValue() const { return endsInValue_; }

    [[nodiscard]] const DeltaEncoderCounts& counts() const { return counts_; }

private:
    bool next();
    void passWalkedRecords();
    bool runOn();
    bool runKnown();
    void keepRun();
    bool encodePiece();
    void count(bool isNew);
    [[nodiscard]] bool same(DictionaryEntry item, const Piece& piece) const;
    [[nodiscard]] bool expects(size_t ahead, const Piece& piece) const;
    bool skipTo(const Piece& piece);
    void skipToLike(const Piece& piece);
    bool patch(const Piece& piece, size_t maxBytes);
    void codeWords(size_t at, std::span<const std::byte> old, std::span<const std::byte> now);
    bool seek();
    bool seekAt(uint32_t hash, uint64_t position);
    bool fromStore(bool inPlace);
    void send(const Piece& piece);
    void run();
    void append(DictionaryEntry item, uint32_t hash);
    void appendUnfound(DictionaryEntry item, uint32_t hash);
    [[nodiscard]] size_t maxPatchOfPage(const Piece& piece) const;
    [[nodiscard]] size_t cheapPatchOfPage(const Piece& piece);
    void putPatch(std::span<const std::byte> now);
    void appendChangedPage(uint32_t slotBefore, const Piece& piece);
    DictionaryEntry putPage(uint32_t slot, const Piece& piece);
    DictionaryEntry keep(const Piece& piece, uint32_t model = 0);
    void settle();
    void asBytes(size_t from, size_t to);
    bool asChanged(uint32_t slot, std::span<const std::byte> bytes);
    [[nodiscard]] uint64_t hashOf(const Piece& piece); // of the current piece
    [[nodiscard]] std::span<const std::byte> bytesOf(const Piece& piece) const {
        return packet_.subspan(piece.at, piece.sizeBytes);
    }
    void literal(Section section, std::span<const std::byte> bytes) {
        literals_[static_cast<size_t>(section)].add(bytes);
    }

    const Limits limits_;
    Dictionary dictionary_;
    PageIndex pageIndex_;
    struct StreamIndex {
        explicit StreamIndex(uint32_t logItems) : items(logItems) {}
        MatchIndex items;
        RunCache runs;
        NoveltyDetector novelty;
    };
    std::vector<std::unique_ptr<StreamIndex>> streams_; // by index of the log
    std::unique_ptr<StreamIndex> firstIndex_;           // allocated in advance for the first stream

    RangeWriter coder_; // of control_ and words_
    ControlWriter control_{coder_};
    WordPredictor words_;
    std::array<SectionBuffer, kSections> literals_; // Control is in coder_
    uint64_t batchRawBytes_ = 0, batchPageBytes_ = 0, batchDroppedBytes_ = 0;
    uint32_t lastStream_ = 0;
    bool endsInValue_ = false;
    bool plain_ = false;
    uint64_t frames_ = 0;
    RawRunSlots rawRunSlots_;
    uint32_t run_ = 0;                      // expected entries that are not in control_ yet
    uint32_t pagesFrom_ = 0, pagesRun_ = 0; // stored pages that are not in control_ yet

    // The current packet.
    std::span<const std::byte> packet_;
    PacketCut cut_; // position after the current piece
    Piece piece_;
    EntryLog* log_ = nullptr;
    MatchIndex* index_ = nullptr;
    RunCache* runs_ = nullptr;
    NoveltyDetector* novelty_ = nullptr;
    bool restPlain_ = false;                // short records are sent plain from here on
    const RecordOffsets* walked_ = nullptr; // record offsets of the current packet, if known
    size_t nextLong_ = 0;                   // index into walked_->longAt
    RunCache::Run open_;                    // the open run of short records, without its bytes
    uint32_t openBytesAt_ = 0;              // its offset in the packet
    bool openIsKnown_ = false;              // all of it matches one of runs_
    bool first_ = true;
    uint64_t hash_ = 0; // hash of the current piece, if computed
    bool hashed_ = false;
    static constexpr uint32_t kNowhere = UINT32_MAX;
    uint32_t nextAt_ = kNowhere; // offset of a piece with a precomputed hash
    uint64_t nextHash_ = 0;
    WordPatch patch_;
    DeltaEncoderCounts counts_;
};

} // namespace mural::delta
