// Announces a node using Avahi during its lifetime.
#pragma once

#include "transport/discovery/announcement.hpp"
#include "transport/discovery/avahi_thread.hpp"

namespace mural {

class AvahiPublisher {
public:
    explicit AvahiPublisher(const Announcement& self);
    [[nodiscard]] std::string trouble() const { return thread_.trouble(); }

private:
    struct Service;
    explicit AvahiPublisher(const std::shared_ptr<Service>& service);
    AvahiThread thread_;
};

} // namespace mural
