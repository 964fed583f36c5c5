// Damaged traces. The input is used twice: as the rest of a file after its header, and as the entries of one valid
// block. Both are read, printed and trimmed. Nothing may crash, and all reads must stay within the block.
#include <sys/mman.h>
#include <unistd.h>

#include "streamcodec/trace/dump/dump.hpp"
#include "streamcodec/trace/trace_writer.hpp"
#include "streamcodec/trace/trim/trim.hpp"
#include "streamcodec/registry_digest.hpp"
#include "streamcodec/wire/packet.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace mural::fuzz {
namespace {

using trace::TraceReader;

class MemoryFile {
public:
    MemoryFile() : fd_(memfd_create("recording", MFD_CLOEXEC)) {}
    [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_.get()); }
    void append(std::span<const std::byte> bytes) {
        lseek(fd_.get(), 0, SEEK_END);
        must(write(fd_.get(), bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
             "there is memory for the file");
    }

private:
    FileDescriptor fd_;
};

uint64_t readAll(const std::string& path) {
    auto reader = TraceReader::open(path);
    if (!reader) {
        must(reader.error().message.find('\n') == std::string::npos, "an error is one line");
        return 0;
    }
    uint64_t lines = 0;
    trace::DumpOptions options;
    (void)trace::dump(**reader, options, [&](const std::string& line) {
        must(line.find('\n') == std::string::npos, "a call is one line");
        return ++lines < 10'000;
    });
    options.summary = true;
    (void)trace::dump(**reader, options, [&](const std::string&) { return true; });
    const MemoryFile part;
    const int64_t frames = (*reader)->frames();
    (void)trace::trim(**reader, frames / 2 + 1, frames, part.path());
    return lines;
}

} // namespace

uint64_t fuzzOne(std::span<const std::byte> input) {
    MemoryFile behindHeader;
    const MemoryFile entries;
    auto header = trace::TraceWriter::create(behindHeader.path());
    must(header && (*header)->begin({}, wire::kVersion, registryDigest()), "a header can be written");
    behindHeader.append(input);
    uint64_t meant = readAll(behindHeader.path());

    auto writer = trace::TraceWriter::create(entries.path());
    must(writer && (*writer)->begin({}, wire::kVersion, registryDigest()), "a header can be written");
    trace::EntryWalk walk(input);
    trace::Entry entry;
    while (walk.next(entry)) must((*writer)->append(entry).ok(), "an entry can be written");
    must((*writer)->flush() && (*writer)->finish(), "a recording can be written");
    meant += readAll(entries.path());
    return meant;
}

} // namespace mural::fuzz
