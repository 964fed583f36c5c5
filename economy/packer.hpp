// The head's side: packets become references to what came before, and the rest. One for all nodes, as all get one stream.
// Linear in the packet. One thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "economy/batch.hpp"
#include "economy/control_code.hpp"
#include "economy/history.hpp"
#include "economy/item_index.hpp"
#include "economy/packet_cut.hpp"
#include "economy/page_index.hpp"
#include "economy/word_patch.hpp"

namespace mural::economy {

// Since the start.
struct PackerCounts {
    uint64_t packets = 0;
    uint64_t records = 0;
    uint64_t rawBytes = 0;
    uint64_t stagedBytes = 0; // after references and patches, before compression
    uint64_t storeHits = 0;   // pages that the nodes had
    uint64_t newPages = 0;    // and that they had not
    uint64_t patches = 0;     // items of which only the changed words went
};

class Packer {
public:
    explicit Packer(const Limits& limits) : limits_(limits), history_(limits) {}

    // False: there was no memory for the store.
    [[nodiscard]] bool ready() const { return history_.ready(); }

    void add(uint32_t stream, std::span<const std::byte> packet);

    // What has been added since clear().
    [[nodiscard]] SectionBytes sections();
    [[nodiscard]] uint64_t stagedBytes();
    [[nodiscard]] uint64_t rawBytes() const { return batchRawBytes_; }
    void clear();
    // The last packet ends within a value that goes ahead of its record: nodes can do nothing with that yet.
    [[nodiscard]] bool endsInValue() const { return endsInValue_; }

    [[nodiscard]] const PackerCounts& counts() const { return counts_; }

private:
    void place(size_t i);
    [[nodiscard]] bool same(Item item, const Piece& piece) const;
    [[nodiscard]] bool expects(size_t ahead, const Piece& piece) const;
    bool skipTo(const Piece& piece);
    bool patch(const Piece& piece, size_t mostBytes);
    bool seek(size_t i);
    bool seekAt(const Piece& piece, uint64_t position);
    bool fromStore(size_t i, bool inPlace);
    void send(const Piece& piece);
    void run();
    void append(Item item, uint32_t hash);
    Item keep(const Piece& piece);
    void settle();
    void restAsBytes(size_t from);
    [[nodiscard]] uint64_t hashOf(const Piece& piece); // of the one in hand
    [[nodiscard]] std::span<const std::byte> bytesOf(const Piece& piece) const { return packet_.subspan(piece.at, piece.sizeBytes); }
    void literal(Section section, std::span<const std::byte> bytes) {
        auto& into = literals_[static_cast<size_t>(section)];
        into.insert(into.end(), bytes.begin(), bytes.end());
    }

    const Limits limits_;
    History history_;
    PageIndex pageIndex_;
    std::vector<std::unique_ptr<ItemIndex>> itemIndexes_; // by place of the log

    ControlWriter control_;
    std::array<std::vector<std::byte>, kSections> literals_; // Control's is in control_
    uint64_t batchRawBytes_ = 0;
    uint32_t lastStream_ = 0;
    bool endsInValue_ = false;
    uint32_t run_ = 0; // items as expected that are not in control_ yet
    uint32_t pagesFrom_ = 0, pagesRun_ = 0; // the same of pages of the store

    // The packet in hand.
    std::span<const std::byte> packet_;
    std::vector<Piece> pieces_;
    ItemLog* log_ = nullptr;
    ItemIndex* index_ = nullptr;
    bool first_ = true;
    uint64_t hash_ = 0; // of the piece in hand, once it is known
    bool hashed_ = false;
    WordPatch patch_;
    PackerCounts counts_;
};

} // namespace mural::economy
