// Finds nodes that are announced using Avahi, during its lifetime.
#pragma once

#include <functional>

#include "transport/discovery/announcement.hpp"
#include "transport/discovery/avahi_thread.hpp"

namespace mural {

class AvahiBrowser {
public:
    // Callbacks; both run in the Avahi thread.
    using Found = std::function<void(const Announcement& node, const std::string& address)>;
    using Lost = std::function<void(const Uuid& uuid)>;
    AvahiBrowser(Found found, Lost lost);
    [[nodiscard]] std::string trouble() const { return thread_.trouble(); }

private:
    struct Search;
    explicit AvahiBrowser(const std::shared_ptr<Search>& search);
    AvahiThread thread_;
};

} // namespace mural
