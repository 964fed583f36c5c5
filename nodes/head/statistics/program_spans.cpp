#include "nodes/head/statistics/program_spans.hpp"

#include <algorithm>
#include <utility>

namespace mural {
namespace {

constexpr std::pair<capture::Wait, SpanKind> kWaits[] = {{capture::Wait::Frames, SpanKind::WaitCredit},
                                                         {capture::Wait::Window, SpanKind::WaitWindow},
                                                         {capture::Wait::Space, SpanKind::WaitSpace},
                                                         {capture::Wait::Reply, SpanKind::WaitReply}};

} // namespace

std::vector<Span> programSpans(int64_t beginNs, int64_t endNs, const ProgramWaits& before, const ProgramWaits& after) {
    std::vector<Span> spans;
    int64_t atNs = beginNs;
    for (const auto& [wait, kind] : kWaits) {
        const auto index = static_cast<size_t>(wait);
        // the program may write anything there
        const uint64_t waited = after[index] > before[index] ? after[index] - before[index] : 0;
        const int64_t leftNs = std::max<int64_t>(endNs - atNs, 0);
        const int64_t ns = static_cast<int64_t>(std::min<uint64_t>(waited, static_cast<uint64_t>(leftNs)));
        if (ns > 0) spans.push_back({kind, atNs, atNs + ns});
        atNs += ns;
    }
    if (endNs > atNs) spans.push_back({SpanKind::Capture, atNs, endNs});
    return spans;
}

} // namespace mural
