// Bytes per frame of a trace, with Mural's delta coding and with competitors; one line of JSON. Run by
// tools/bench/delta.
//
//   stream_sizes FILE.mural [WARM_FRAMES]     the first frames are start-up and reported separately
//
// Exit status 77: the trace has no more frames than that.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sys/mman.h>
#include <vector>

#include "common/json/json_text.hpp"
#include "common/base/clock.hpp"
#include "common/memory/malloc_tuning.hpp"
#include "tools/bench/stream/stream_coding.hpp"

using namespace mural;
using namespace mural::bench;

namespace {

constexpr uint64_t kStoreBytes = uint64_t{1} << 30;
constexpr int kZstdLevel = 3; // Zstandard's default

// Rounds alternate between the methods, and medians are reported. Interruptions are a large part of a round with a
// short trace, so the number of rounds depends on the time.
constexpr int kMinRounds = 3, kMaxRounds = 15;
constexpr int64_t kLongEnoughMs = 4000;
constexpr size_t kMemoryBytes = size_t{384} << 20;

// Under a hypervisor that reclaims memory, committing the first 100 MB takes as long as compressing them. The memory is
// therefore committed before each method; clearing it counts.
void haveMemory() {
    void* const memory = mmap(nullptr, kMemoryBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return;
    madvise(memory, kMemoryBytes, MADV_HUGEPAGE);
    for (size_t at = 0; at < kMemoryBytes; at += 4096) static_cast<volatile std::byte*>(memory)[at] = std::byte{1};
    munmap(memory, kMemoryBytes);
}

// Result of one method in one round.
struct Counted {
    double startBytes = 0, bytes = 0; // of the start-up frames, and of the others
    double startCpuNs = 0, cpuNs = 0;
};

// Frames of the trace.
struct Frames {
    int64_t start = 0, counted = 0;
    uint64_t startRaw = 0, raw = 0;
};

Result<std::unique_ptr<StreamCoding>> makeCoding(size_t number) {
    switch (number) {
    case 0: return filteredDeltaCoding(kStoreBytes);
    case 1: return zstdCoding(kZstdLevel);
    case 2: return differenceCoding();
    default: return unfilteredDeltaCoding(kStoreBytes);
    }
}
constexpr size_t kCodings = 4;

Result<Counted> run(StreamCoding& coding, const char* path, int64_t warm, Frames& frames) {
    Counted counted;
    std::string wrong;
    frames = {};
    uint64_t frameRaw = 0;
    FrameReader to;
    to.packet = [&](const StreamPacket& p) {
        frameRaw += p.payload.size();
        coding.packet(p);
    };
    to.ended = [&](int64_t frame) {
        const bool start = frame <= warm;
        (start ? frames.startRaw : frames.raw) += std::exchange(frameRaw, 0);
        ++(start ? frames.start : frames.counted);
        auto bytes = coding.frameEnds();
        if (!bytes)
            wrong = "frame " + std::to_string(frame) + ": " + bytes.error().message;
        else
            (start ? counted.startBytes : counted.bytes) += static_cast<double>(*bytes);
        if (start) counted.startCpuNs = static_cast<double>(coding.cpuNs());
    };
    if (auto read = readFrames(path, to); !read) return read.error();
    counted.cpuNs = static_cast<double>(coding.cpuNs()) - counted.startCpuNs;
    int64_t shown = 0;
    FrameReader again;
    again.packet = [&](const StreamPacket& p) {
        if (!wrong.empty() || shown >= frames.start + frames.counted) return; // nothing is sent after the last frame
        if (auto same = coding.comesOut(p); !same)
            wrong = "frame " + std::to_string(shown + 1) + ": " + same.error().message;
    };
    again.ended = [&](int64_t frame) { shown = frame; };
    if (auto read = readFrames(path, again); !read) return read.error();
    if (!wrong.empty()) return Error{coding.name() + ", " + wrong};
    return counted;
}

double median(const std::vector<Counted>& rounds, double Counted::*of) {
    std::vector<double> values;
    for (const Counted& c : rounds) values.push_back(c.*of);
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

constexpr int kNothingToMeasure = 77;

int fail(const std::string& why, int status = 2) {
    std::cerr << "stream_sizes: " << why << '\n';
    return status;
}

} // namespace

int main(int argc, char** argv) {
    keepFreedMemory(); // as in the head
    if (argc < 2 || argc > 3)
        return fail("give a recording that mural run --record has made, and how many frames are start-up");
    const int64_t warm = argc > 2 ? std::strtoll(argv[2], nullptr, 10) : 10;
    Frames frames;
    std::vector<std::string> names(kCodings);
    std::vector<std::vector<Counted>> all(kCodings);
    const Deadline longEnough = Deadline::inMs(kLongEnoughMs);
    for (int round = 0; round < kMinRounds || (round < kMaxRounds && !longEnough.passed()); ++round)
        for (size_t i = 0; i < kCodings; ++i) {
            haveMemory();
            auto coding = makeCoding(i);
            if (!coding) return fail(coding.error().message);
            auto counted = run(**coding, argv[1], warm, frames);
            if (!counted) return fail(counted.error().message);
            names[i] = (*coding)->name();
            all[i].push_back(*counted);
        }
    if (frames.counted == 0)
        return fail(std::string(argv[1]) + " has " + std::to_string(frames.start) +
                        " frames, no more than are start-up; record more",
                    kNothingToMeasure);

    const auto count = static_cast<double>(frames.counted);
    nlohmann::json report;
    report["frames"] = frames.counted;
    report["startFrames"] = frames.start;
    report["rawBytesPerFrame"] = static_cast<double>(frames.raw) / count;
    report["startRawBytes"] = frames.startRaw;
    for (size_t i = 0; i < kCodings; ++i) {
        nlohmann::json& coding = report["codings"][names[i]];
        coding["bytesPerFrame"] = median(all[i], &Counted::bytes) / count;
        coding["startBytes"] = median(all[i], &Counted::startBytes);
        coding["startCpuUs"] = median(all[i], &Counted::startCpuNs) / 1000;
        coding["cpuUsPerFrame"] = median(all[i], &Counted::cpuNs) / 1000 / count;
    }
    std::cout << jsonText(report) << '\n';
    return 0;
}
