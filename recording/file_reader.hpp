// Reads a recording. Nothing in the file is believed: sizes are bounded, each part is checked against its checksum. Used by
// one thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "recording/about.hpp"
#include "recording/entry.hpp"
#include "transport/file_descriptor.hpp"

struct ZSTD_DCtx_s;

namespace mural::recording {

class FileReader {
public:
    // Of this build's stream: another wire version or registry is an error.
    static Result<std::unique_ptr<FileReader>> open(const std::string& path);
    static Result<std::unique_ptr<FileReader>> open(FileDescriptor file, const std::string& name);
    FileReader(const FileReader&) = delete;
    FileReader& operator=(const FileReader&) = delete;
    ~FileReader();

    [[nodiscard]] const About& about() const { return about_; }
    // One line where the file's end is missing; empty: it is whole.
    [[nodiscard]] const std::string& notice() const { return notice_; }
    [[nodiscard]] const std::vector<IndexRow>& blocks() const { return blocks_; }
    [[nodiscard]] int64_t frames() const { return frames_; } // of the wall
    [[nodiscard]] uint64_t sizeBytes() const { return sizeBytes_; }
    // For who wants frames that are not there, of so many; of none: why.
    [[nodiscard]] Error noSuchFrames(int64_t frames) const;

    // That every block is as it was written, without unpacking them.
    Result<void> verify();
    // The block's entries, all of them sound; they lie in memory of the reader until the next call. An error names the frames
    // before it, which are good to who has read all blocks until there.
    Result<std::span<const std::byte>> read(size_t block);

private:
    static constexpr const char* kElsewhere = "take another copy of it, or record again"; // where this file is of no use

    FileReader(FileDescriptor file, std::string name);
    Result<void> readHeader();
    Result<bool> readIndex(); // false: there is no trailer
    Result<void> findBlocks();
    Result<BlockHeader> readPacked(size_t block); // into packed_
    bool readAt(uint64_t offset, std::span<std::byte> into) const;
    [[nodiscard]] uint64_t endOf(size_t block) const; // where the next one begins
    [[nodiscard]] Error damaged(uint64_t offset, const std::string& what, const std::string& next = kElsewhere) const;
    [[nodiscard]] Error damagedBlock(size_t block, const std::string& what) const;

    const FileDescriptor file_;
    const std::string name_;
    ZSTD_DCtx_s* const unpacker_;
    uint64_t sizeBytes_ = 0;
    uint64_t blocksAt_ = 0;  // behind the header
    uint64_t blocksEnd_ = 0; // where the index begins, or the last whole block ends
    About about_;
    std::string notice_;
    std::vector<IndexRow> blocks_;
    int64_t frames_ = 0;
    std::vector<std::byte> packed_;
    std::vector<std::byte> raw_;
};

// All entries in their order. False from `take` ends it.
template <class Take> Result<void> forEachEntry(FileReader& reader, Take take) {
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

} // namespace mural::recording
