// The files of the page, which are parts of the binary. No path of a request reaches the file system.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "tools/mural/page/http/page_site.hpp"

namespace mural::page {

struct PageAsset {
    std::string_view path; // "/assets/page.js"
    std::string_view type;
    bool isGzip = false;
    std::string_view bytes;
};

// Returns all files; empty: the build left the page out. A build step writes its source (embed_assets.py).
[[nodiscard]] std::span<const PageAsset> pageAssets();
// Returns the JSON schema of the control interface's lines.
[[nodiscard]] std::string_view controlSchema();

// Returns the file of a path, "/" for the page itself. Without the page's files, "/" is a text that says so.
[[nodiscard]] std::optional<HttpResponse> assetResponse(std::string_view path);

} // namespace mural::page
