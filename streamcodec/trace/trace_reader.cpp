#include "streamcodec/trace/trace_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <zstd.h>

#include "streamcodec/trace/checksum.hpp"
#include "streamcodec/registry_digest.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::trace {
namespace {

template <class T> std::span<std::byte> bytesOf(T& value) { return std::as_writable_bytes(std::span(&value, 1)); }

bool soundShape(const BlockHeader& h) {
    return h.magic == kBlockMagic && h.rawBytes <= kMaxBlockBytes &&
           h.packedBytes <= ZSTD_COMPRESSBOUND(kMaxBlockBytes);
}

constexpr const char* kEndMissing = "its end is missing (the head was killed, or the file is truncated)";

} // namespace

Result<std::unique_ptr<TraceReader>> TraceReader::open(const std::string& path) {
    FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file.valid()) return Error{"trace " + path + ": cannot be read: " + std::strerror(errno) + "; check the name"};
    return open(std::move(file), path);
}

Result<std::unique_ptr<TraceReader>> TraceReader::open(FileDescriptor file, const std::string& name) {
    struct stat about {};
    if (fstat(file.get(), &about) != 0 || !S_ISREG(about.st_mode))
        return Error{"trace " + name + ": is not a file; choose a file of mural run --record"};
    std::unique_ptr<TraceReader> reader(new TraceReader(std::move(file), name));
    reader->sizeBytes_ = static_cast<uint64_t>(about.st_size);
    if (auto r = reader->readHeader(); !r) return r.error();
    auto indexed = reader->readIndex();
    if (!indexed) return indexed.error();
    if (indexed.value()) return reader;
    if (auto r = reader->findBlocks(); !r) return r.error();
    return reader;
}

TraceReader::TraceReader(FileDescriptor file, std::string name)
    : file_(std::move(file)), name_(std::move(name)), unpacker_(ZSTD_createDCtx()) {}

TraceReader::~TraceReader() { ZSTD_freeDCtx(unpacker_); }

Error TraceReader::damaged(uint64_t offset, const std::string& what, const std::string& next) const {
    return Error{"trace " + name_ + " is damaged at byte " + std::to_string(offset) + ": " + what + "; " + next};
}

Error TraceReader::damagedBlock(size_t number, const std::string& what) const {
    int64_t before = 0;
    for (size_t i = 0; i < number; ++i) before += blocks_[i].framesEnded;
    const uint64_t offset = blocks_[number].offset;
    if (before == 0) return damaged(offset, what + ", and no frame ends before it", kElsewhere);
    const std::string good = before == 1 ? "1" : "1-" + std::to_string(before);
    return damaged(offset, what,
                   "earlier frames are valid (" + good + "): extract them with mural trim " + name_ + " " + good +
                       " -o good.mural, " + kElsewhere);
}

Error TraceReader::noSuchFrames(int64_t frames) const {
    if (frames > 0) {
        return Error{"the trace has " + std::to_string(frames) + " frames" +
                     (notice_.empty() ? "" : std::string(", as ") + kEndMissing) + "; choose some of them, such as 1-" +
                     std::to_string(frames)};
    }
    if (notice_.empty())
        return Error{"trace " + name_ +
                     " has no frame, because its program showed no picture; mural dump prints its calls"};
    return Error{"trace " + name_ + " has no complete frame: " + kEndMissing + ", valid data ends at byte " +
                 std::to_string(blocksEnd_) + " of " + std::to_string(sizeBytes_) + "; " + kElsewhere};
}

bool TraceReader::readAt(uint64_t offset, std::span<std::byte> into) const {
    while (!into.empty()) {
        const ssize_t n = pread(file_.get(), into.data(), into.size(), static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        offset += static_cast<uint64_t>(n);
        into = into.subspan(static_cast<size_t>(n));
    }
    return true;
}

Result<void> TraceReader::readHeader() {
    Header header{};
    const bool read = readAt(0, bytesOf(header));
    if (!read || std::memcmp(header.magic, kMagic, sizeof kMagic) != 0)
        return Error{name_ + " is not a trace of Mural; choose a file of mural run --record"};
    if (header.version != kVersion) {
        return Error{"trace " + name_ + " has version " + std::to_string(header.version) +
                     " of the format, but this Mural reads version " + std::to_string(kVersion) +
                     "; use the Mural that recorded it"};
    }
    blocksAt_ = sizeof header + header.aboutBytes;
    if (header.aboutBytes > kMaxAboutBytes || blocksAt_ > sizeBytes_)
        return damaged(0, "its header is longer than the file");
    std::string text(header.aboutBytes, '\0');
    if (!readAt(sizeof header, std::as_writable_bytes(std::span(text))))
        return damaged(sizeof header, "its header cannot be read");
    if (checksumOf({beforeChecksum(header), std::as_bytes(std::span(text))}) != header.checksum)
        return damaged(0, "the checksum of its header is wrong");
    auto about = aboutFromJson(text);
    if (!about) return damaged(sizeof header, about.error().message);
    about_ = std::move(*about);
    if (header.wireVersion == wire::kVersion && header.registryDigest == registryDigest()) return {};
    return Error{"trace " + name_ + " was recorded by a Mural with other commands (version " + about_.version +
                 "); read it with that version, or record it again"};
}

Result<bool> TraceReader::readIndex() {
    Trailer trailer{};
    if (sizeBytes_ < blocksAt_ + sizeof trailer || !readAt(sizeBytes_ - sizeof trailer, bytesOf(trailer))) return false;
    if (std::memcmp(trailer.magic, kEndMagic, sizeof kEndMagic) != 0) return false;
    const uint64_t end = sizeBytes_ - sizeof trailer, at = trailer.indexOffset;
    IndexHeader header{};
    if (checksumOf({beforeChecksum(trailer)}) != trailer.checksum || at < blocksAt_ || at > end ||
        end - at < sizeof header || !readAt(at, bytesOf(header)))
        return damaged(end, "the checksum of its last bytes is wrong");
    if (header.magic != kIndexMagic || (end - at - sizeof header) / sizeof(IndexRow) != header.blocks ||
        (end - at - sizeof header) % sizeof(IndexRow) != 0)
        return damaged(at, "its index is missing");
    blocks_.resize(header.blocks);
    const auto rows = std::as_writable_bytes(std::span(blocks_));
    if (!readAt(at + sizeof header, rows) || checksumOf({beforeChecksum(header), rows}) != header.checksum)
        return damaged(at, "the checksum of its index is wrong");
    frames_ = static_cast<int64_t>(header.frames);
    blocksEnd_ = at;
    // Rows must be contiguous. Blocks are validated when they are read, so a bad block does not affect earlier ones.
    uint64_t minimum = blocksAt_;
    for (const IndexRow& row : blocks_) {
        if (row.offset < minimum || row.offset > blocksEnd_ || blocksEnd_ - row.offset < sizeof(BlockHeader))
            return damaged(at, "its index has invalid entries");
        minimum = row.offset + sizeof(BlockHeader);
    }
    if ((blocks_.empty() ? blocksEnd_ : blocks_.front().offset) != blocksAt_)
        return damaged(at, "its index begins at a wrong offset");
    return true;
}

uint64_t TraceReader::endOf(size_t number) const {
    return number + 1 < blocks_.size() ? blocks_[number + 1].offset : blocksEnd_;
}

Result<void> TraceReader::findBlocks() {
    uint64_t at = blocksAt_;
    BlockHeader block{};
    while (sizeBytes_ - at >= sizeof block && readAt(at, bytesOf(block)) && soundShape(block) &&
           sizeBytes_ - at - sizeof block >= block.packedBytes) {
        blocks_.push_back({at, block.firstFrame, block.framesEnded, block.entries});
        frames_ += block.framesEnded;
        at += sizeof block + block.packedBytes;
    }
    blocksEnd_ = at;
    notice_ = "trace " + name_ + ": its end is missing (the head was killed, or the file is truncated); " +
              std::to_string(frames_) + " complete frames, up to byte " + std::to_string(at) + " of " +
              std::to_string(sizeBytes_);
    return {};
}

Result<void> TraceReader::verify() {
    for (size_t i = 0; i < blocks_.size(); ++i)
        if (const auto block = readPacked(i); !block) return block.error();
    return {};
}

Result<BlockHeader> TraceReader::readPacked(size_t number) {
    const IndexRow& row = blocks_[number];
    BlockHeader header{};
    if (!readAt(row.offset, bytesOf(header)) || !soundShape(header)) return damagedBlock(number, "a block is missing");
    if (row.offset + sizeof header + header.packedBytes != endOf(number))
        return damagedBlock(number, "a block does not end at the start of the next one");
    packed_.resize(header.packedBytes);
    if (!readAt(row.offset + sizeof header, packed_)) return damagedBlock(number, "a block cannot be read");
    const bool same =
        header.firstFrame == row.firstFrame && header.framesEnded == row.framesEnded && header.entries == row.entries;
    if (!same || checksumOf({beforeChecksum(header), packed_}) != header.checksum)
        return damagedBlock(number, "the checksum of a block is wrong");
    return header;
}

Result<std::span<const std::byte>> TraceReader::read(size_t number) {
    const auto packed = readPacked(number);
    if (!packed) return packed.error();
    const BlockHeader& header = packed.value();
    raw_.resize(header.rawBytes);
    const size_t rawBytes = ZSTD_decompressDCtx(unpacker_, raw_.data(), raw_.size(), packed_.data(), packed_.size());
    if (ZSTD_isError(rawBytes) || rawBytes != header.rawBytes)
        return damagedBlock(number, "a block cannot be decompressed");
    EntryWalk walk(raw_);
    Entry entry;
    ClientEvent event;
    uint32_t entries = 0;
    while (walk.next(entry)) {
        ++entries;
        if (entry.stream == 0 && !parseEvent(entry.payload, event))
            return damagedBlock(number, "a block has an unknown event");
    }
    if (walk.malformed() || entries != header.entries) return damagedBlock(number, "a block has invalid entries");
    return std::span<const std::byte>(raw_);
}

} // namespace mural::trace
