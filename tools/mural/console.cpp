#include "tools/mural/console.hpp"

#include <cerrno>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unistd.h>

namespace mural::cli {

namespace {

constexpr int64_t kTerminalMs = 100;
constexpr int64_t kLogMs = 5'000;

const char* plural(int64_t count) { return count == 1 ? "" : "s"; }

} // namespace

std::string sizeText(double sizeBytes) {
    if (sizeBytes < 1000) return fmt::format("{:.0f} B", sizeBytes);
    if (sizeBytes < 1e6) return fmt::format("{:.1f} kB", sizeBytes / 1e3);
    if (sizeBytes < 1e9) return fmt::format("{:.2f} MB", sizeBytes / 1e6);
    return fmt::format("{:.2f} GB", sizeBytes / 1e9);
}

std::string countsText(const std::map<std::string, int64_t>& countsBy) {
    std::vector<std::pair<int64_t, std::string>> order;
    for (const auto& [command, count] : countsBy) order.emplace_back(-count, command);
    std::sort(order.begin(), order.end());
    std::string text;
    for (const auto& [negative, command] : order)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", command, -negative);
    return text;
}

Console::Console(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), nextLine_(Deadline::inMs(terminal_ ? 0 : kLogMs)) {}

// One write per line, so that lines of several processes do not mix.
void Console::write(const std::string& text) {
    const std::string bytes = (progressShown_ ? "\r\033[K" : "") + text;
    progressShown_ = false;
    for (size_t done = 0; done < bytes.size();) {
        const ssize_t n = ::write(STDERR_FILENO, bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return;
        done += static_cast<size_t>(n);
    }
}

void Console::error(const std::string& text) { write("mural: " + text + "\n"); }

void Console::say(const std::string& text) {
    if (!quiet_) error(text);
}

void Console::progress(int64_t frame, double framesPerSecond, double bytesPerFrame) {
    if (quiet_ || !nextLine_.passed()) return;
    nextLine_ = Deadline::inMs(terminal_ ? kTerminalMs : kLogMs);
    std::string text = fmt::format("mural: frame {}, {:.1f} frames/s", frame, framesPerSecond);
    if (bytesPerFrame > 0) text += ", " + sizeText(bytesPerFrame) + " per frame";
    write(terminal_ ? text : text + "\n");
    progressShown_ = terminal_;
}

namespace {

// "not verified: 3 frames (front buffer 2, window not current 1)"
std::string uncomparedText(const SessionReport& r) {
    std::string reasons;
    for (const auto& [reason, count] : r.uncomparedFramesBy)
        reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", reason, count);
    return fmt::format("not verified: {} frame{}{}", r.uncomparedFrames, plural(r.uncomparedFrames),
                       reasons.empty() ? "" : " (" + reasons + ")");
}

// "culling: 62 % of 1200 vertices left out; not examined: first uses 200, client memory 12"
std::vector<std::string> cullingLines(const SessionReport& r) {
    CullingReport sum;
    for (const NodeReport& n : r.nodes) {
        sum.isOn = sum.isOn || n.culling.isOn;
        sum.verticesLeftOut += n.culling.verticesLeftOut;
        sum.verticesDrawn += n.culling.verticesDrawn;
        sum.audits += n.culling.audits;
        sum.faults += n.culling.faults;
        for (const auto& [reason, vertices] : n.culling.verticesUnexamined) sum.verticesUnexamined[reason] += vertices;
    }
    if (!sum.isOn) return {};
    const int64_t all = sum.verticesLeftOut + sum.verticesDrawn;
    std::string line = fmt::format(
        "culling: {:.0f} % of {} vertices left out",
        100.0 * static_cast<double>(sum.verticesLeftOut) / std::max(1.0, 1.0 * static_cast<double>(all)), all);
    if (!sum.verticesUnexamined.empty()) line += "; not examined: " + countsText(sum.verticesUnexamined);
    std::vector<std::string> lines{line};
    if (sum.audits > 0)
        lines.push_back(fmt::format(
            "culling audit: {} draw{} left out in all or in part, {} of them with samples in the node's tiles",
            sum.audits, plural(sum.audits), sum.faults));
    return lines;
}

} // namespace

std::vector<std::string> reportLines(const SessionReport& r) {
    std::vector<std::string> lines;
    std::string first = fmt::format(
        "{} frame{} in {:.1f} s, {:.1f} frames/s, {} per frame to each node, {} round trip{}", r.frames,
        plural(r.frames), r.seconds, r.framesPerSecond, sizeText(r.bytesPerFrame), r.roundTrips, plural(r.roundTrips));
    if (r.roundTrips > 0 && r.frames > 0)
        first +=
            fmt::format(" ({:.2f} per frame: {})", static_cast<double>(r.roundTrips) / static_cast<double>(r.frames),
                        countsText(r.roundTripsBy));
    lines.push_back(first);
    if (r.delta.on && r.frames > 0) {
        const DeltaReport& e = r.delta;
        const auto frames = static_cast<double>(r.frames);
        lines.push_back(fmt::format("delta coding: {} per frame, {} of it new to the nodes, {} compressed; {:.0f} of "
                                    "{:.0f} pages were cached; encoding took {:.0f} us per frame, {:.0f} ns per call",
                                    sizeText(e.rawBytes / frames), sizeText(e.stagedBytes / frames),
                                    sizeText(e.wireBytes / frames), e.pageHits, e.pageHits + e.newPages,
                                    1e6 * e.encodeSeconds / frames,
                                    e.records > 0 ? 1e9 * e.encodeSeconds / e.records : 0.0));
        if (e.deferredRecords + e.droppedRecords > 0)
            lines.push_back(fmt::format("filter: {:.0f} record{} deferred until first use", e.deferredRecords,
                                        plural(static_cast<int64_t>(e.deferredRecords))) +
                            (e.droppedRecords > 0
                                 ? fmt::format("; {:.0f} unused record{} dropped ({})", e.droppedRecords,
                                               plural(static_cast<int64_t>(e.droppedRecords)), sizeText(e.droppedBytes))
                                 : ""));
    }
    double packed = 0, raw = 0;
    for (const NodeReport& n : r.nodes) packed += n.pictureBytes, raw += n.pictureRawBytes;
    if (raw > 0 && r.frames > 0)
        lines.push_back(fmt::format("pictures: {} per frame, compressed to {}",
                                    sizeText(raw / static_cast<double>(r.frames)),
                                    sizeText(packed / static_cast<double>(r.frames))));
    for (std::string& line : cullingLines(r)) lines.push_back(std::move(line));
    for (const EqualizerReport& e : r.equalizers) {
        if (e.frames == 0) continue;
        if (e.divides == "frames") {
            const std::string pace = e.framesPerSecond > 0
                                         ? fmt::format("at most {:.1f} per second at the end", e.framesPerSecond)
                                         : std::string("without a limit of their rate at the end");
            lines.push_back(fmt::format("equalizer \"{}\": frames began {}", e.name, pace));
            continue;
        }
        if (e.divides == "zoom") {
            lines.push_back(fmt::format("equalizer \"{}\": zoom changed after {} of {} frame{}; at the end {:.2f}",
                                        e.name, e.moves, e.frames, plural(e.frames), e.zoom));
            continue;
        }
        std::string nodes;
        for (const auto& [node, part] : e.nodes)
            nodes += fmt::format("{}node {} {:.0f} %", nodes.empty() ? "" : ", ", node, 100 * part);
        lines.push_back(fmt::format("equalizer \"{}\": parts of the {} moved after {} of {} frame{}; at the end {}; "
                                    "nodes were busy for {:.0f} % of the longest time",
                                    e.name, e.divides, e.moves, e.frames, plural(e.frames), nodes, 100 * e.efficiency));
    }
    if (r.verifiedFrames > 0) {
        std::string line = fmt::format("verified {} frame{}, {} pixels: {} differ", r.verifiedFrames,
                                       plural(r.verifiedFrames), r.verifiedPixels, r.differingPixels);
        if (r.differingPixels > 0) line += fmt::format(", by up to {} of 255", r.largestDifference);
        if (r.squaredDifference > 0)
            line += fmt::format(", PSNR {:.1f} dB",
                                10 * std::log10(255.0 * 255 * 4 * static_cast<double>(r.verifiedPixels) /
                                                static_cast<double>(r.squaredDifference)));
        lines.push_back(line);
    }
    if (r.uncomparedFrames > 0) lines.push_back(uncomparedText(r));
    if (r.savedPictures > 0) {
        lines.push_back(
            fmt::format("saved {} picture{}, the last in {}", r.savedPictures, plural(r.savedPictures), r.lastPicture));
    }
    if (!r.recording.empty()) {
        lines.push_back(fmt::format("recorded {} frame{} in {}, {}", r.recordedFrames, plural(r.recordedFrames),
                                    r.recording, sizeText(static_cast<double>(r.recordedBytes))));
    }
    if (r.callsUnsupported > 0) {
        const std::string by = countsText(r.callsUnsupportedBy);
        lines.push_back(fmt::format("{} call{} of unsupported commands{}; see mural list-commands --unsupported",
                                    r.callsUnsupported, plural(r.callsUnsupported), by.empty() ? "" : ": " + by));
    }
    for (const NodeReport& n : r.nodes) {
        if (n.swaps.swaps > 0)
            lines.push_back(fmt::format("swap barrier: {} nodes showed {} frame{} within {:.2f} ms of each other "
                                        "(median), {:.2f} ms (99 %), {:.2f} ms (maximum); clock error {:.3f} ms",
                                        n.swaps.members, n.swaps.swaps, plural(n.swaps.swaps), n.swaps.medianNs / 1e6,
                                        n.swaps.p99Ns / 1e6, n.swaps.maxNs / 1e6, n.swaps.clockErrorNs / 1e6));
        if (n.joins > 0)
            lines.push_back(fmt::format("node {} rejoined {} time{}, the last time in {:.1f} s, with {}", n.node,
                                        n.joins, plural(n.joins), n.secondsToRejoin, sizeText(n.snapshotBytes)));
        if (n.lost && !n.hasConnected)
            lines.push_back(fmt::format("node {} did not connect", n.node));
        else if (n.lost)
            lines.push_back(fmt::format("node {} was lost after {} frame{}", n.node, n.frames, plural(n.frames)));
    }
    return lines;
}

} // namespace mural::cli
