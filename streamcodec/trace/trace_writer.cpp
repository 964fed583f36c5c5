#include "streamcodec/trace/trace_writer.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <zstd.h>

#include "streamcodec/trace/checksum.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::trace {
namespace {

template <class T> std::span<const std::byte> bytesOf(const T& value) { return std::as_bytes(std::span(&value, 1)); }

} // namespace

Result<std::unique_ptr<TraceWriter>> TraceWriter::create(const std::string& path, int level) {
    // O_NONBLOCK: a FIFO without a reader is an error, and does not block.
    FileDescriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0666));
    if (!file.valid())
        return Error{"trace " + path + ": cannot be written: " + std::strerror(errno) + "; choose another place"};
    return std::unique_ptr<TraceWriter>(new TraceWriter(path, std::move(file), level));
}

TraceWriter::TraceWriter(std::string path, FileDescriptor file, int level)
    : path_(std::move(path)), file_(std::move(file)), level_(level), packer_(ZSTD_createCCtx()) {}

TraceWriter::~TraceWriter() { ZSTD_freeCCtx(packer_); }

Error TraceWriter::fileError(const char* what) const {
    return Error{"trace " + path_ + ": " + what + ": " + std::strerror(errno) +
                 "; free space, or choose another place"};
}

Result<void> TraceWriter::write(std::span<const std::byte> bytes) {
    auto at = static_cast<off_t>(totals_.fileBytes);
    while (!bytes.empty()) {
        const ssize_t n = pwrite(file_.get(), bytes.data(), bytes.size(), at);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return fileError("cannot be written");
        at += n;
        bytes = bytes.subspan(static_cast<size_t>(n));
    }
    totals_.fileBytes = static_cast<uint64_t>(at);
    return {};
}

Result<void> TraceWriter::begin(const About& about, uint32_t wireVersion, uint64_t registryDigest) {
    const std::string json = toJson(about);
    Header header{};
    std::memcpy(header.magic, kMagic, sizeof kMagic);
    header.version = kVersion;
    header.wireVersion = wireVersion;
    header.registryDigest = registryDigest;
    header.aboutBytes = static_cast<uint32_t>(json.size());
    const auto text = std::as_bytes(std::span(json));
    header.checksum = checksumOf({beforeChecksum(header), text});
    if (auto r = write(bytesOf(header)); !r) return r;
    return write(text);
}

Result<void> TraceWriter::append(const Entry& entry) {
    appendEntry(raw_, entry);
    ++entries_;
    ClientEvent event;
    uint32_t ended = 0;
    if (entry.stream != 0)
        ended = frames_.packet(entry.stream, entry.payload);
    else if (parseEvent(entry.payload, event) && event.kind == Event::ClientGone)
        frames_.clientGone(event.client);
    framesEnded_ += ended;
    const bool atFrame = ended > 0 && raw_.size() >= kBlockBytes;
    const bool full = raw_.size() > kMaxBlockBytes - entryBytes(wire::kMaxPacketBytes);
    return atFrame || full ? flush() : Result<void>();
}

Result<void> TraceWriter::flush() {
    if (raw_.empty()) return {};
    packed_.resize(ZSTD_compressBound(raw_.size()));
    const size_t packedBytes =
        ZSTD_compressCCtx(packer_, packed_.data(), packed_.size(), raw_.data(), raw_.size(), level_);
    if (ZSTD_isError(packedBytes))
        return Error{"trace " + path_ + ": cannot compress a block: " + ZSTD_getErrorName(packedBytes) +
                     "; memory may be short"};
    const auto packed = std::span<const std::byte>(packed_).first(packedBytes);
    BlockHeader header{};
    header.magic = kBlockMagic;
    header.packedBytes = static_cast<uint32_t>(packedBytes);
    header.rawBytes = static_cast<uint32_t>(raw_.size());
    header.entries = entries_;
    header.firstFrame = static_cast<uint64_t>(totals_.frames) + 1;
    header.framesEnded = framesEnded_;
    header.checksum = checksumOf({beforeChecksum(header), packed});
    const WriterTotals before = totals_;
    auto written = write(bytesOf(header));
    if (written) written = write(packed);
    if (!written) {
        totals_ = before; // partial blocks do not count
        return written;
    }
    index_.push_back({before.fileBytes, header.firstFrame, header.framesEnded, header.entries});
    totals_.frames += framesEnded_;
    totals_.rawBytes += raw_.size();
    raw_.clear();
    entries_ = framesEnded_ = 0;
    return {};
}

Result<void> TraceWriter::finish() {
    const auto rows = std::as_bytes(std::span(index_));
    IndexHeader header{kIndexMagic, static_cast<uint32_t>(index_.size()), static_cast<uint64_t>(totals_.frames), 0};
    header.checksum = checksumOf({beforeChecksum(header), rows});
    Trailer trailer{totals_.fileBytes, 0, {}};
    trailer.checksum = checksumOf({beforeChecksum(trailer)});
    std::memcpy(trailer.magic, kEndMagic, sizeof kEndMagic);
    if (ftruncate(file_.get(), static_cast<off_t>(totals_.fileBytes)) != 0)
        return fileError("cannot be truncated to its last block");
    if (auto r = write(bytesOf(header)); !r) return r;
    if (auto r = write(rows); !r) return r;
    return write(bytesOf(trailer));
}

} // namespace mural::trace
