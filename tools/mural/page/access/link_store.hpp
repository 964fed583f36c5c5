// Keeps the links of a session in a file of its folder, so they outlive the page. The file has the hashes of the
// tokens. It ends with the session.
#pragma once

#include <cstdint>
#include <string>

#include "common/base/result.hpp"
#include "tools/mural/page/access/link_table.hpp"

namespace mural::page {

// Replaces the file as a whole, with mode 600. Errors: the file cannot be written.
Result<void> keepLinks(const std::string& path, const LinkTable& links, int64_t nowNs);
// Adds the links of the file. Returns false if there is a file, and it is no list of links.
bool restoreLinks(const std::string& path, LinkTable& links, int64_t nowNs);

} // namespace mural::page
