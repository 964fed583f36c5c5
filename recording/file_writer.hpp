// Writes a recording. Used by one thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "recording/about.hpp"
#include "recording/entry.hpp"
#include "recording/wall_frames.hpp"
#include "transport/file_descriptor.hpp"

struct ZSTD_CCtx_s;

namespace mural::recording {

struct WriterTotals {
    int64_t frames = 0;     // of the wall, in whole blocks
    uint64_t fileBytes = 0;
    uint64_t rawBytes = 0;  // before they were packed
};

class FileWriter {
public:
    // The file is there and empty from then on. level: of zstd.
    static Result<std::unique_ptr<FileWriter>> create(const std::string& path, int level = kDefaultLevel);
    FileWriter(const FileWriter&) = delete;
    FileWriter& operator=(const FileWriter&) = delete;
    ~FileWriter();

    Result<void> begin(const About& about, uint32_t wireVersion, uint64_t registryDigest); // first
    Result<void> append(const Entry& entry);
    // What has come so far is a block, and in the file.
    Result<void> flush();
    // Index and trailer, for the blocks that are in the file: flush() before, unless that has failed.
    Result<void> finish();

    [[nodiscard]] bool hasUnwritten() const { return !raw_.empty(); }
    [[nodiscard]] int64_t framesSeen() const { return frames_.frames(); } // also those that are not in the file yet
    [[nodiscard]] const WriterTotals& totals() const { return totals_; }

    static constexpr int kDefaultLevel = 1;

private:
    FileWriter(std::string path, FileDescriptor file, int level);
    Result<void> write(std::span<const std::byte> bytes);
    [[nodiscard]] Error fileError(const char* what) const;

    const std::string path_;
    const FileDescriptor file_;
    const int level_;
    ZSTD_CCtx_s* const packer_;
    std::vector<std::byte> raw_; // of the block that is being filled
    uint32_t entries_ = 0;
    uint32_t framesEnded_ = 0;
    WallFrames frames_;
    std::vector<std::byte> packed_;
    std::vector<IndexRow> index_;
    WriterTotals totals_;
};

} // namespace mural::recording
