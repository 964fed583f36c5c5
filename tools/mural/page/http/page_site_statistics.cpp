// The resources of the page that are made from the head's statistics.
#include <algorithm>
#include <chrono>
#include <memory>

#include <boost/asio/steady_timer.hpp>

#include "common/json/json_text.hpp"
#include "tools/mural/page/http/http_text.hpp"
#include "tools/mural/page/http/page_site.hpp"
#include "tools/mural/page/hub/output_list.hpp"
#include "tools/mural/stat/chrome_trace.hpp"
#include "tools/mural/stat/prometheus_text.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;

constexpr std::chrono::milliseconds kTraceRetry{500};

Result<cli::SessionFrames> framesOf(const Json& reply) {
    const auto result = reply.find("result");
    if (result == reply.end()) return Error{reply.value("error", std::string("the session does not reply"))};
    cli::SessionFrames frames;
    if (const auto added = cli::addReply(frames, *result); !added) return added.error();
    return frames;
}

} // namespace

// The first request switches the statistics on, so frames may come only after it.
void PageSite::answerTrace(size_t count, int tries, const OnResponse& onResponse) {
    hub_.askHead("frames", {{"since", 1}, {"newest", count}}, [this, count, tries, onResponse](const Json& reply) {
        auto frames = framesOf(reply);
        if (!frames) return onResponse(textResponse(503, frames.error().message));
        cli::dropPartialBegin(*frames);
        if (frames->frames.size() >= count || tries == 0) {
            if (frames->frames.empty()) return onResponse(textResponse(503, "the program draws no frames now"));
            return onResponse(jsonResponse(200, cli::chromeTrace(*frames)));
        }
        const auto timer = std::make_shared<boost::asio::steady_timer>(io_, kTraceRetry);
        timer->async_wait([this, timer, count, tries, onResponse](const boost::system::error_code& error) {
            if (!error) answerTrace(count, tries - 1, onResponse);
        });
    });
}

// Requests the proofs of the outputs first, so that a scrape reports their age at its own time.
void PageSite::answerMetrics(const OnResponse& onResponse) {
    hub_.askHead("outputs", Json::object(), [this, onResponse](const Json& requested) {
        if (!requested.contains("result")) return answerMetricsOf(Json(), onResponse);
        const auto timer = std::make_shared<boost::asio::steady_timer>(io_, std::chrono::nanoseconds(kProofTimeNs));
        timer->async_wait([this, timer, onResponse](const boost::system::error_code& error) {
            if (error) return;
            hub_.askHead("outputs", Json::object(), [this, onResponse](const Json& reply) {
                answerMetricsOf(reply.value("result", Json()), onResponse);
            });
        });
    });
}

void PageSite::answerMetricsOf(const Json& outputs, const OnResponse& onResponse) {
    constexpr int kMeansOf = 120; // as mural stat
    hub_.askHead("frames", {{"since", 1}, {"newest", kMeansOf}}, [this, outputs, onResponse](const Json& reply) {
        auto frames = framesOf(reply);
        if (frames) frames->outputs = outputs;
        std::string text = frames ? cli::prometheusText({*frames}) : std::string();
        text += pageMetrics(hub_.numbers(), hub_.hello().value("session", std::string()), frames.ok());
        onResponse({200, "text/plain; version=0.0.4; charset=utf-8", std::move(text), {}});
    });
}

} // namespace mural::page
