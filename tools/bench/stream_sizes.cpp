// Bytes per frame of a recording, by Mural's economy and by what it is measured against; one line of JSON. tools/bench/economy
// runs it.
//
//   stream_sizes FILE.mural [WARM_FRAMES]     the first frames are start-up: what they need is told apart
#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/bench/stream/ways.hpp"

using namespace mural;
using namespace mural::bench;

namespace {

constexpr uint64_t kStoreBytes = uint64_t{1} << 30;
constexpr int kZstdLevel = 3; // its default

struct Counted {
    std::unique_ptr<Way> way;
    uint64_t startBytes = 0, bytes = 0; // of the first frames, and of those behind them
    int64_t startCpuNs = 0;
};

int fail(const std::string& why) {
    std::cerr << "stream_sizes: " << why << '\n';
    return 2;
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argc > 3) return fail("give a recording that mural run --record has made, and how many frames are start-up");
    const int64_t warm = argc > 2 ? std::strtoll(argv[2], nullptr, 10) : 10;
    auto economy = economyWay(kStoreBytes);
    if (!economy) return fail(economy.error().message);
    std::vector<Counted> all;
    all.push_back({std::move(*economy)});
    all.push_back({zstdWay(kZstdLevel)});
    all.push_back({differenceWay()});

    uint64_t startRaw = 0, raw = 0, frameRaw = 0;
    int64_t counted = 0;
    std::string wrong;
    FrameReader to;
    to.packet = [&](const StreamPacket& p) {
        frameRaw += p.payload.size();
        for (Counted& c : all) c.way->packet(p);
    };
    to.ended = [&](int64_t frame) {
        const bool start = frame <= warm;
        (start ? startRaw : raw) += std::exchange(frameRaw, 0);
        counted += !start;
        for (Counted& c : all) {
            auto bytes = c.way->frameEnds();
            if (!bytes) wrong = c.way->name() + ", frame " + std::to_string(frame) + ": " + bytes.error().message;
            else (start ? c.startBytes : c.bytes) += *bytes;
            if (start) c.startCpuNs = c.way->cpuNs();
        }
    };
    auto frames = readFrames(argv[1], to);
    if (!frames) return fail(frames.error().message);
    if (!wrong.empty()) return fail(wrong);
    if (counted == 0) return fail(std::string(argv[1]) + " has " + std::to_string(*frames) + " frames, no more than are start-up; record more");

    nlohmann::json report;
    report["frames"] = counted;
    report["startFrames"] = *frames - counted;
    report["rawBytesPerFrame"] = static_cast<double>(raw) / static_cast<double>(counted);
    report["startRawBytes"] = startRaw;
    for (const Counted& c : all) {
        nlohmann::json& way = report["ways"][c.way->name()];
        way["bytesPerFrame"] = static_cast<double>(c.bytes) / static_cast<double>(counted);
        way["startBytes"] = c.startBytes;
        way["startCpuUs"] = static_cast<double>(c.startCpuNs) / 1000;
        way["cpuUsPerFrame"] = static_cast<double>(c.way->cpuNs() - c.startCpuNs) / 1000 / static_cast<double>(counted);
    }
    std::cout << report.dump() << '\n';
    return 0;
}
