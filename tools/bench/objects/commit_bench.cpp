#include <cstdio>

#include "common/base/clock.hpp"
#include "objects/ends/object_writer.hpp"
#include "objects/ends/reader_core.hpp"
#include "tools/bench/objects/benches.hpp"

namespace mural::bench {

namespace {

using namespace mural::objects;

// Takes the place of a session's stream: a copy of each message.
class StreamMemory : public MessageSink {
public:
    void toAll(std::span<const std::byte> message) override {
        bytes.insert(bytes.end(), message.begin(), message.end());
        ends.push_back(bytes.size());
    }
    void toOne(PeerId, std::span<const std::byte> message) override { toAll(message); }
    void clear() {
        bytes.clear();
        ends.clear();
    }
    std::vector<std::byte> bytes;
    std::vector<size_t> ends;
};

double microseconds(int64_t sinceNs, int count) {
    return static_cast<double>(threadCpuNowNs() - sinceNs) / 1000 / count;
}

} // namespace

int benchCommits(const ObjectBenchOptions& options) {
    const int frames = options.quick ? 20 : 2000;
    StreamMemory stream, toWriter;
    ObjectWriter writer(stream, {.blobs = BlobTransfer::Place, .keepsPushed = false});
    ReaderEnd end(toWriter);
    auto made = writer.share(BenchState{}, {.name = "state"});
    if (!made || !made.value().commit()) return 1;
    Shared<BenchState> state = std::move(made.value());
    const auto deliver = [&](bool& isGood) {
        size_t from = 0;
        for (const size_t to : stream.ends) {
            isGood = isGood && end.input(std::span(stream.bytes).subspan(from, to - from), 0).ok();
            from = to;
        }
    };
    bool isGood = true;
    deliver(isGood);
    uint64_t frame = 0;
    std::vector<double> commits, unchanged, inputs, reads, sizes;
    for (int turn = 0; turn < std::min(options.turns, 50); ++turn) {
        int64_t begin = threadCpuNowNs();
        for (int i = 0; i < frames; ++i) isGood = isGood && state.commit().ok();
        unchanged.push_back(microseconds(begin, frames));
        stream.clear();
        begin = threadCpuNowNs();
        for (int i = 0; i < frames; ++i) {
            state.edit().numbers[7] += 1;
            isGood = isGood && state.commit().ok();
        }
        commits.push_back(microseconds(begin, frames));
        sizes.push_back(static_cast<double>(stream.bytes.size()) / frames);
        const std::vector<size_t> ends = stream.ends;
        double inputNs = 0, readNs = 0;
        size_t from = 0;
        for (const size_t to : ends) {
            begin = threadCpuNowNs();
            isGood = isGood && end.input(std::span(stream.bytes).subspan(from, to - from), 0).ok();
            end.frame(++frame);
            const int64_t applied = threadCpuNowNs();
            const auto snapshot = end.reader().stateAt<BenchState>(frame, "state");
            readNs += static_cast<double>(threadCpuNowNs() - applied);
            inputNs += static_cast<double>(applied - begin);
            isGood = isGood && snapshot.ok();
            end.frameDone(frame - 1);
            from = to;
        }
        inputs.push_back(inputNs / 1000 / frames);
        reads.push_back(readNs / 1000 / frames);
        const auto snapshot = end.reader().stateAt<BenchState>(frame, "state");
        isGood = isGood && snapshot && *snapshot.value() == state.get();
    }
    const auto row = [](const char* name, const std::vector<double>& values) {
        const Summary summary = summaryOf(values);
        std::printf("%-46s %8.2f (%.2f to %.2f)\n", name, summary.median, summary.low, summary.high);
    };
    std::printf("\nState of 37 fields, 1.4 KB, one field changed per frame (CPU us, with quartiles)\n");
    row("writer: commit without a change", unchanged);
    row("writer: commit of one field", commits);
    row("reader: receive the commit", inputs);
    row("reader: snapshot of the frame", reads);
    row("bytes per commit", sizes);
    return isGood ? 0 : 1;
}

} // namespace mural::bench
