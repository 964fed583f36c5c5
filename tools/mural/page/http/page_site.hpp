// The HTTP resources of the page, without sockets: requests become responses. Used by the thread of its io_context.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "tools/mural/page/access/request_origin.hpp"
#include "tools/mural/page/http/connection_site.hpp"
#include "tools/mural/page/hub/page_hub.hpp"
#include "tools/mural/page/protocol/rate_limit.hpp"

namespace mural::page {

struct SiteConfig {
    std::vector<std::string> hosts; // by which the page may be reached; empty: any, on a Unix socket
    std::string embedOrigin;        // may show the page in a frame; empty: nobody
    bool hasOpenMetrics = false;    // /metrics needs no token
};

class PageSite : public ConnectionSite {
public:
    PageSite(boost::asio::io_context& io, PageHub& hub, SiteConfig config);

    void handle(HttpRequest request, OnResponse onResponse) override;
    [[nodiscard]] std::optional<HttpResponse> refusal(const HttpRequest& request) const override;
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> commonHeaders() const override;
    int join(ViewerSocket& socket, const std::string& address) override { return hub_.join(socket, address); }
    void received(int viewer, std::string_view text) override { hub_.received(viewer, text); }
    void left(int viewer) override { hub_.left(viewer); }

private:
    struct Call { // an accepted request of the interface
        HttpRequest request;
        Role role = Role::View;
        std::string path;  // below /api/v1/
        std::string query; // after "?"
    };

    void handleApi(const std::string& path, const std::string& query, HttpRequest request,
                   const OnResponse& onResponse);
    void answer(const Call& call, const OnResponse& onResponse);
    void answerDocument(const Call& call, const OnResponse& onResponse);
    void answerPicture(const Call& call, const OnResponse& onResponse);
    void answerConfig(const Call& call, const OnResponse& onResponse);
    void answerLinks(const Call& call, const OnResponse& onResponse);
    void answerOperation(const Call& call, const OnResponse& onResponse);
    void answerTrace(size_t frames, int tries, const OnResponse& onResponse);
    void answerMetrics(const OnResponse& onResponse);
    // outputs: the reply of the operation `outputs`; null: the head does not reply.
    void answerMetricsOf(const nlohmann::json& outputs, const OnResponse& onResponse);
    void answerHealth(bool isReady, const OnResponse& onResponse);
    void performFor(const Call& call, const std::string& operation, const nlohmann::json& arguments,
                    const OnResponse& onResponse);

    boost::asio::io_context& io_;
    PageHub& hub_;
    const SiteConfig config_;
    const KnownHosts hosts_;
    RateLimit requests_{100}; // of all clients together
};

} // namespace mural::page
