// Records the work of an output's thread on a picture. Outside of it the thread waits for pictures.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "nodes/frame_spans/span_scope.hpp"
#include "nodes/head/statistics/frame_statistics.hpp"

namespace mural {

// Runs `work` as a span of Output, and adds the thread's spans to the frame. spans: of the calling thread. statistics:
// null: none.
template <class Work>
void recordOutput(FrameStatistics* statistics, ThreadSpans& spans, uint32_t client, uint32_t frame, std::string thread,
                  Work&& work) {
    const bool isOn = statistics && statistics->isOn();
    recordThread(spans, isOn, SpanKind::WaitPicture);
    {
        const SpanScope outputs(SpanKind::Output);
        std::forward<Work>(work)();
    }
    if (!isOn) return;
    const int64_t nowNs = quickNowNs();
    statistics->add(client, frame, {SpanProcess::Head, 0, std::move(thread), spans.take(nowNs)}, nowNs);
}

} // namespace mural
