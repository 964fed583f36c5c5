// Writes a trace. Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "streamcodec/trace/about.hpp"
#include "streamcodec/trace/entry.hpp"
#include "streamcodec/trace/wall_frames.hpp"
#include "common/ipc/file_descriptor.hpp"

struct ZSTD_CCtx_s;

namespace mural::trace {

struct WriterTotals {
    int64_t frames = 0; // of the wall, in complete blocks
    uint64_t fileBytes = 0;
    uint64_t rawBytes = 0; // before compression
};

class TraceWriter {
public:
    // Creates an empty file. level: Zstandard level.
    static Result<std::unique_ptr<TraceWriter>> create(const std::string& path, int level = kDefaultLevel);
    TraceWriter(const TraceWriter&) = delete;
    TraceWriter& operator=(const TraceWriter&) = delete;
    ~TraceWriter();

    Result<void> begin(const About& about, uint32_t wireVersion, uint64_t registryDigest); // call first
    Result<void> append(const Entry& entry);
    // Ends the current block and writes it.
    Result<void> flush();
    // Writes index and trailer for the blocks in the file. Call flush() before, unless it failed.
    Result<void> finish();

    [[nodiscard]] bool hasUnwritten() const { return !raw_.empty(); }
    [[nodiscard]] int64_t framesSeen() const { return frames_.frames(); } // including frames that are not written yet
    [[nodiscard]] const WriterTotals& totals() const { return totals_; }

    static constexpr int kDefaultLevel = 1;

private:
    TraceWriter(std::string path, FileDescriptor file, int level);
    Result<void> write(std::span<const std::byte> bytes);
    [[nodiscard]] Error fileError(const char* what) const;

    const std::string path_;
    const FileDescriptor file_;
    const int level_;
    ZSTD_CCtx_s* const packer_;
    std::vector<std::byte> raw_; // of the current block
    uint32_t entries_ = 0;
    uint32_t framesEnded_ = 0;
    WallFrames frames_;
    std::vector<std::byte> packed_;
    std::vector<IndexRow> index_;
    WriterTotals totals_;
};

} // namespace mural::trace
