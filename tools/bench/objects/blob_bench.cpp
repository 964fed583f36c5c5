#include <cstdio>
#include <cstring>
#include <sys/mman.h>

#include "common/base/clock.hpp"
#include "objects/ends/object_writer.hpp"
#include "tools/bench/objects/benches.hpp"
#include "tools/bench/objects/reader_processes.hpp"

namespace mural::bench {

namespace {

using namespace mural::objects;

constexpr size_t kBlobBytes = size_t{16} << 20;

struct BlobState {
    uint64_t turn = 0; // also the first and the last word of the blob
    Blob blob;
    template <class Visit> void fields(Visit& visit) { visit(turn, blob); }
};

double millisecondsSince(int64_t beginNs) { return static_cast<double>(monotonicNowNs() - beginNs) / 1e6; }

// The only object is the newest one of this name.
bool checkBlob(ObjectReader& reader) {
    const auto state = reader.stateAt<BlobState>(1, "mesh", Deadline::inMs(0));
    if (!state) return false;
    const auto words = state.value()->blob.as<uint64_t>();
    return state.value()->turn == 0 || (words.size() == kBlobBytes / 8 && words.front() == state.value()->turn &&
                                        words.back() == state.value()->turn);
}

struct BlobTimes {
    std::vector<double> warmCopy, newCopy, fill, publishFilled, copyAndPublish;
};

// Fresh memory costs page faults, so a copy into memory that was used before is faster.
void measureCopies(const std::vector<uint64_t>& data, std::vector<std::byte>& warm, BlobTimes& times) {
    int64_t begin = monotonicNowNs();
    std::memcpy(warm.data(), data.data(), kBlobBytes);
    times.warmCopy.push_back(millisecondsSince(begin));
    begin = monotonicNowNs();
    void* const fresh = ::mmap(nullptr, kBlobBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (fresh == MAP_FAILED) return;
    std::memcpy(fresh, data.data(), kBlobBytes);
    times.newCopy.push_back(millisecondsSince(begin));
    ::munmap(fresh, kBlobBytes);
}

int measure(size_t count, const ObjectBenchOptions& options) {
    ReaderProcesses readers(LineKind::SharedMemory, count, readObjects(checkBlob));
    ObjectWriter writer(readers, {.blobs = BlobTransfer::Place, .keepsPushed = false});
    auto made = writer.share(BlobState{}, {.name = "mesh"});
    if (!made || !made.value().commit() || readers.awaitAcknowledgements() != count) return 1;
    Shared<BlobState> state = std::move(made.value());
    std::vector<uint64_t> data(kBlobBytes / 8);
    for (size_t i = 0; i < data.size(); ++i) data[i] = i * 0x9e3779b97f4a7c15ULL;
    std::vector<std::byte> warm(kBlobBytes, std::byte{1});
    BlobTimes times;
    int wrong = 0;
    uint64_t serial = 0;
    Blob before;
    // Publishes a blob. The blob before is dropped outside of the measured time.
    const auto publish = [&](Result<Blob> blob) {
        if (!blob) return false;
        before = state.get().blob;
        state.edit() = {serial, blob.value()};
        return state.commit() && readers.awaitAcknowledgements() == count;
    };
    for (int turn = 0; turn < (options.quick ? 2 : std::min(options.turns, 30)); ++turn) {
        before = Blob();
        measureCopies(data, warm, times);
        data.front() = data.back() = ++serial;
        int64_t begin = monotonicNowNs();
        wrong += !publish(Blob::copyOf(std::as_bytes(std::span(data))));
        times.copyAndPublish.push_back(millisecondsSince(begin));
        data.front() = data.back() = ++serial;
        before = Blob();
        begin = monotonicNowNs();
        int64_t filled = begin;
        auto blob = Blob::make(kBlobBytes, [&](std::span<std::byte> into) {
            std::memcpy(into.data(), data.data(), kBlobBytes);
            times.fill.push_back(millisecondsSince(begin));
            filled = monotonicNowNs();
        });
        wrong += !publish(std::move(blob));
        times.publishFilled.push_back(millisecondsSince(filled));
    }
    const Summary published = summaryOf(times.publishFilled), copied = summaryOf(times.copyAndPublish);
    std::printf("%9zu %9.2f %9.2f %9.2f   %6.2f (%.2f to %.2f)   %6.2f (%.2f to %.2f)\n", count,
                summaryOf(times.warmCopy).median, summaryOf(times.newCopy).median, summaryOf(times.fill).median,
                published.median, published.low, published.high, copied.median, copied.low, copied.high);
    return wrong;
}

} // namespace

int benchBlobs(const ObjectBenchOptions& options) {
    std::printf("\nBlob of 16 MiB to processes of this machine (ms, medians with quartiles)\n");
    std::printf("%9s %9s %9s %9s   %-23s %s\n", "processes", "memcpy", "to new", "fill", "filled to known by all",
                "copied to known by all");
    int wrong = 0;
    for (const size_t count : {1, 4, 8}) wrong += measure(count, options);
    return wrong;
}

} // namespace mural::bench
