#include "nodes/render/goodbye.hpp"

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <sys/resource.h>

#include "nodes/frame_transfer/picture_sender.hpp"
#include "nodes/render/barrier_part.hpp"
#include "nodes/render/exchange_part.hpp"
#include "nodes/player/stream_player.hpp"

namespace mural {

namespace {

double processCpuSeconds() {
    rusage r{};
    getrusage(RUSAGE_SELF, &r);
    return static_cast<double>(r.ru_utime.tv_sec + r.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(r.ru_utime.tv_usec + r.ru_stime.tv_usec);
}

// Largest resident memory of this program. getrusage() would include the process before exec.
int64_t peakMemoryBytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmHWM:")) return std::strtoll(line.c_str() + 6, nullptr, 10) * 1024;
    }
    return 0;
}

nlohmann::json cullingJson(const culling::CullingCounts& c) {
    nlohmann::json unexamined = nlohmann::json::object();
    for (size_t i = 0; i < c.unexamined.size(); ++i)
        if (c.unexamined[i] > 0) unexamined[culling::nameOf(static_cast<culling::WhyWhole>(i))] = c.unexamined[i];
    return {{"drawsLeftOut", c.drawsLeftOut},
            {"drawsCut", c.drawsCut},
            {"drawsWhole", c.drawsWhole},
            {"verticesLeftOut", c.verticesLeftOut},
            {"verticesDrawn", c.verticesDrawn},
            {"verticesUnexamined", std::move(unexamined)},
            {"boxBytes", c.boxBytes},
            {"audits", c.audits},
            {"faults", c.faults}};
}

} // namespace

nlohmann::json goodbyeOf(const GoodbyeParts& parts) {
    const auto& [player, exchange, sender, barrier, members, receivedBytes] = parts;
    nlohmann::json bye;
    const PlayerCounts counts = player ? player->counts() : PlayerCounts{};
    bye["commands"] = counts.commands;
    bye["malformed"] = counts.malformed;
    bye["lacking"] = counts.lacking;
    bye["frames"] = counts.frames;
    bye["receivedBytes"] = receivedBytes;
    bye["cpuSeconds"] = processCpuSeconds();
    bye["peakMemoryBytes"] = peakMemoryBytes();
    if (counts.culling.isOn) bye["culling"] = cullingJson(counts.culling);
    if (exchange) bye["exchangeBytes"] = exchange->bytesSent();
    if (sender && sender->packs()) {
        bye["pictureBytes"] = sender->packedBytes();
        bye["pictureRawBytes"] = sender->rawBytes();
    }
    if (const auto numbers = barrier && barrier->barrier() ? barrier->barrier()->numbers() : std::nullopt)
        bye["swapBarrier"] = {
            {"members", members},           {"swaps", numbers->skew.swaps}, {"medianNs", numbers->skew.medianNs},
            {"p99Ns", numbers->skew.p99Ns}, {"maxNs", numbers->skew.maxNs}, {"clockErrorNs", numbers->clockErrorNs}};
    return bye;
}

} // namespace mural
