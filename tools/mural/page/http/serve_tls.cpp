#include "tools/mural/page/http/browser_connection.hpp"

namespace mural::page {

void serveTls(TlsStream stream, ConnectionSite& site, std::string address, std::shared_ptr<void> slot) {
    std::make_shared<BrowserConnection<TlsStream>>(std::move(stream), site, std::move(address), std::move(slot))
        ->begin();
}

} // namespace mural::page
