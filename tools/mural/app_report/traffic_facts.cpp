#include "tools/mural/app_report/traffic_facts.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <thread>

#include "tools/mural/app_report/round_trip_advice.hpp"
#include "tools/mural/console.hpp"

namespace mural::cli {

namespace {

constexpr double kUsableShare = 0.9;        // of a link's rate
constexpr double kRoundTripS = 0.2e-3;      // on a quiet local network, with the work of both ends
constexpr const char* kVerify = "--verify"; // name of the comparison's round trips

std::map<std::string, int64_t> tripsOf(const AppRun& run) {
    std::map<std::string, int64_t> trips;
    if (!run.report.is_object()) return trips;
    const auto by = run.report.find("roundTripsBy");
    if (by == run.report.end() || !by->is_object()) return trips;
    for (const auto& [command, count] : by->items())
        if (count.is_number() && command != kVerify) trips[command] = count.get<int64_t>();
    return trips;
}

double perFrame(const AppRun& run, double total) {
    return total / std::max<double>(1, static_cast<double>(run.frames()));
}

double deltaBytes(const AppRun& run, const char* field) {
    if (!run.report.is_object()) return 0;
    const auto delta = run.report.find("delta");
    return delta != run.report.end() && delta->is_object() ? delta->value(field, 0.0) : 0;
}

double peakNodeMemory(const AppRun& run) {
    double most = 0;
    if (!run.report.is_object() || !run.report.contains("nodes")) return 0;
    for (const auto& node : run.report["nodes"])
        if (node.is_object()) most = std::max(most, node.value("peakMemoryBytes", 0.0));
    return most;
}

} // namespace

double roundTripsPerFrame(const AppMeasured& m) {
    int64_t all = 0;
    for (const auto& [command, count] : tripsOf(m.tiles)) all += count;
    return perFrame(m.tiles, static_cast<double>(all));
}

Section roundTripFacts(const AppMeasured& m) {
    Section s{"roundTrips", "Round trips", {}};
    if (m.tiles.frames() == 0) return s;
    const double trips = roundTripsPerFrame(m);
    s.add("perFrame", "round trips per frame", trips, fmt::format("{:.2f}", trips));
    for (const auto& [command, count] : tripsOf(m.tiles))
        s.add("by." + command, command, perFrame(m.tiles, static_cast<double>(count)),
              fmt::format("{} in {} frames", count, m.tiles.frames()), roundTripAdvice(command));
    return s;
}

Section trafficFacts(const AppMeasured& m) {
    Section s{"traffic", "Data and memory", {}};
    if (m.tiles.frames() == 0) return s;
    const double raw = perFrame(m.tiles, deltaBytes(m.tiles, "programBytes")), sent = m.tiles.number("bytesPerFrame");
    s.add("rawBytesPerFrame", "stream per frame", raw, sizeText(raw));
    s.add("sentBytesPerFrame", "after delta coding, to each node", sent,
          raw > 0 ? fmt::format("{}, {:.2g} % of the stream", sizeText(sent), 100 * sent / raw) : sizeText(sent));
    if (m.trace.frames > 0) {
        s.add("firstFrameBytes", "up to the first frame", m.trace.firstFrameBytes,
              sizeText(static_cast<double>(m.trace.firstFrameBytes)));
        const auto texture = static_cast<double>(m.trace.textureBytes),
                   buffer = static_cast<double>(m.trace.bufferBytes);
        s.add("textureBytes", "textures in all frames", m.trace.textureBytes, sizeText(texture));
        s.add("bufferBytes", "buffers and arrays in all frames", m.trace.bufferBytes, sizeText(buffer));
    }
    const double memory = peakNodeMemory(m.tiles);
    s.add("nodeMemoryBytes", "memory of a node, at most", memory, sizeText(memory),
          "with software GL; a GPU keeps textures and framebuffers in its own memory");
    return s;
}

Section speedFacts(const AppMeasured& m) {
    Section s{"speed", "Speed", {}};
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    const double native = m.native.number("framesPerSecond");
    if (m.native.frames() > 1)
        s.add("nativeFramesPerSecond", "without Mural (measured)", native, fmt::format("{:.1f} frames/s", native));
    else if (m.native.performed())
        s.add("nativeFramesPerSecond", "without Mural (measured)", nullptr, "no two frames were counted");
    if (m.balance.frames() > 1) {
        const double here = m.balance.number("framesPerSecond");
        s.add("muralFramesPerSecond", "on two local nodes (measured)", here,
              fmt::format("{:.1f} frames/s; nodes and program share {} core{}", here, cores, cores == 1 ? "" : "s"));
    }
    if (m.tiles.frames() == 0) return s;
    const double bytes = m.tiles.number("bytesPerFrame"), trips = roundTripsPerFrame(m);
    for (const double gbit : {1.0, 10.0}) {
        const double limit = bytes > 0 ? gbit * 1e9 / 8 * kUsableShare / bytes : 0;
        if (limit > 0)
            s.add(fmt::format("limitOf{:.0f}Gbit", gbit), fmt::format("limit of {:.0f} Gbit/s (estimated)", gbit),
                  limit, fmt::format("{:.0f} frames/s, from the bytes per frame", limit));
    }
    if (trips > 0)
        s.add("limitOfRoundTrips", "limit of the round trips (estimated)", 1 / (trips * kRoundTripS),
              fmt::format("{:.0f} frames/s, with {:.1f} ms for each", 1 / (trips * kRoundTripS), kRoundTripS * 1e3));
    return s;
}

} // namespace mural::cli
