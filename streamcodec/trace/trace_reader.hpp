// Reads a trace. Input is untrusted: sizes are bounded, and every part has a checksum. Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "streamcodec/trace/about.hpp"
#include "streamcodec/trace/entry.hpp"
#include "common/ipc/file_descriptor.hpp"

struct ZSTD_DCtx_s;

namespace mural::trace {

class TraceReader {
public:
    // Opens a trace of this build's stream format. Another wire version or registry is an error.
    static Result<std::unique_ptr<TraceReader>> open(const std::string& path);
    static Result<std::unique_ptr<TraceReader>> open(FileDescriptor file, const std::string& name);
    TraceReader(const TraceReader&) = delete;
    TraceReader& operator=(const TraceReader&) = delete;
    ~TraceReader();

    [[nodiscard]] const About& about() const { return about_; }
    // Returns one line if the end of the file is missing; empty: complete.
    [[nodiscard]] const std::string& notice() const { return notice_; }
    [[nodiscard]] const std::vector<IndexRow>& blocks() const { return blocks_; }
    [[nodiscard]] int64_t frames() const { return frames_; } // of the wall
    [[nodiscard]] uint64_t sizeBytes() const { return sizeBytes_; }
    // Returns the error for missing frames, or the reason why there are none.
    [[nodiscard]] Error noSuchFrames(int64_t frames) const;

    // Checks all checksums without decompressing.
    Result<void> verify();
    // Returns the validated entries of a block, valid until the next call. An error names the preceding frames, which
    // are usable after reading all earlier blocks.
    Result<std::span<const std::byte>> read(size_t block);

private:
    // next step for an unusable file
    static constexpr const char* kElsewhere = "use another copy of it, or record it again";

    TraceReader(FileDescriptor file, std::string name);
    Result<void> readHeader();
    Result<bool> readIndex(); // false: no trailer
    Result<void> findBlocks();
    Result<BlockHeader> readPacked(size_t block); // reads into packed_
    bool readAt(uint64_t offset, std::span<std::byte> into) const;
    [[nodiscard]] uint64_t endOf(size_t block) const; // start of the next block
    [[nodiscard]] Error damaged(uint64_t offset, const std::string& what, const std::string& next = kElsewhere) const;
    [[nodiscard]] Error damagedBlock(size_t block, const std::string& what) const;

    const FileDescriptor file_;
    const std::string name_;
    ZSTD_DCtx_s* const unpacker_;
    uint64_t sizeBytes_ = 0;
    uint64_t blocksAt_ = 0;  // end of the header
    uint64_t blocksEnd_ = 0; // start of the index, or end of the last complete block
    About about_;
    std::string notice_;
    std::vector<IndexRow> blocks_;
    int64_t frames_ = 0;
    std::vector<std::byte> packed_;
    std::vector<std::byte> raw_;
};

// Visits all entries in order until `take` returns false.
template <class Take> Result<void> forEachEntry(TraceReader& reader, Take take) {
    for (size_t i = 0; i < reader.blocks().size(); ++i) {
        auto block = reader.read(i);
        if (!block) return block.error();
        EntryWalk walk(*block);
        Entry entry;
        while (walk.next(entry))
            if (!take(entry)) return {};
    }
    return {};
}

} // namespace mural::trace
