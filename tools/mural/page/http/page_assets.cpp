#include "tools/mural/page/http/page_assets.hpp"

#include <algorithm>

namespace mural::page {

namespace {

constexpr std::string_view kWithoutPage =
    "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>Mural</title>\n"
    "<h1>This build of Mural has no page</h1>\n"
    "<p>The files of the page were missing when Mural was built. The WebSocket and the HTTP interface work.\n"
    "<p>To include the page: <code>cd tools/page &amp;&amp; npm ci &amp;&amp; npm run build</code>, then build Mural "
    "again.\n";

} // namespace

std::optional<HttpResponse> assetResponse(std::string_view path) {
    const std::string_view wanted = path == "/" ? "/index.html" : path;
    const auto assets = pageAssets();
    const auto found = std::ranges::find(assets, wanted, &PageAsset::path);
    if (found == assets.end()) {
        if (wanted != "/index.html") return std::nullopt;
        return HttpResponse{200, "text/html; charset=utf-8", std::string(kWithoutPage), {}};
    }
    HttpResponse response{200, std::string(found->type), std::string(found->bytes), {}};
    if (found->isGzip) response.headers.emplace_back("Content-Encoding", "gzip");
    return response;
}

} // namespace mural::page
