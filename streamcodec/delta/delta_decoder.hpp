// Decoder of a node: restores the packets byte for byte. Treats input as untrusted: malformed data is an error, after
// which nothing can be decoded. Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "common/base/result.hpp"
#include "streamcodec/delta/batch.hpp"
#include "streamcodec/delta/control_code.hpp"
#include "streamcodec/delta/dictionary/dictionary.hpp"
#include "streamcodec/delta/entropy/word_predictor.hpp"

namespace mural::delta {

class DeltaDecoder {
public:
    explicit DeltaDecoder(const Limits& limits);

    // Returns false if there was no memory for the store.
    [[nodiscard]] bool ready() const { return dictionary_.ready(); }

    // Begins a batch, which must stay valid until its last packet is taken.
    void begin(const SectionBytes& sections);
    // Returns the next packet, valid until the next call; false at the end of the batch.
    Result<bool> next(uint32_t& stream, std::span<const std::byte>& packet);

    // Fault injection: patched GL commands keep their old contents.
    void loseWords() { loseWords_ = true; }

private:
    using Problem = const char*; // null: no error
    Problem step(DeltaOp what, uint32_t n);
    Problem run(uint32_t n);
    Problem patch(uint32_t spans);
    Problem fresh(uint32_t sizeBytes, bool page);
    Problem pages(uint32_t n);
    Problem other(uint32_t n);
    Problem plain(std::optional<uint32_t> slot);
    Problem changedRun(uint32_t slot);
    static void loseChanges(std::span<const std::byte> old, std::span<std::byte> run);
    template <class Reader, class Change>
    static Problem eachSpan(Reader& reader, std::span<std::byte> bytes, uint32_t spans, Change&& change);
    Problem changeItem(DictionaryEntry& item, std::span<std::byte> bytes, uint32_t spans);
    Problem changeSpans(std::span<std::byte> bytes, uint32_t spans);
    void changeWords(size_t at, std::span<std::byte> words);
    [[nodiscard]] DictionaryEntry keep(std::span<const std::byte> bytes, bool page, uint32_t model = 0);
    [[nodiscard]] bool take(Section section, size_t sizeBytes, std::span<const std::byte>& into);
    [[nodiscard]] bool room(size_t sizeBytes);
    std::span<std::byte> put(std::span<const std::byte> bytes);

    Dictionary dictionary_;
    const std::unique_ptr<std::byte[]> packet_; // of the largest packet size
    size_t packetBytes_ = 0;
    SectionBytes sections_;
    RangeReader coder_; // of control_ and words_
    ControlReader control_{CodedBytes(coder_)};
    SpanReader spans_{PlainBytes()};
    WordPredictor words_;
    uint32_t stream_ = 0;
    EntryLog* log_ = nullptr; // null: between packets
    bool ended_ = false;
    uint64_t batchBytes_ = 0;
    uint32_t steps_ = 0;
    bool done_ = false; // end of the batch
    bool loseWords_ = false;
};

} // namespace mural::delta
