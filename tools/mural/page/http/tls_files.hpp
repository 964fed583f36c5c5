// The certificate of the page and its key: files of the user, or a pair of its own.
#pragma once

#include <string>

#include "common/base/result.hpp"

namespace mural::page {

struct TlsFiles {
    std::string certificate, key; // PEM files
};

// Returns the pair in $XDG_STATE_HOME/mural, otherwise ~/.local/state/mural. Creates it on first use: P-256, ten years,
// for these host names and addresses. Errors: the folder cannot be written.
Result<TlsFiles> ownTlsFiles();
// Returns the SHA-256 of the certificate, as browsers show it: "AB:CD:…".
Result<std::string> fingerprintOf(const std::string& certificate);

} // namespace mural::page
