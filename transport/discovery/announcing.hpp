// Announces a daemon during its lifetime, by Mural's beacon and by Avahi where it runs.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "transport/discovery/announcer.hpp"
#include "transport/discovery/avahi_publisher.hpp"
#include "transport/discovery/discovery.hpp"
#include "common/ipc/file_descriptor.hpp"

namespace mural {

class Announcing {
public:
    // `self` is announced as it is, with kind Here.
    static Result<std::unique_ptr<Announcing>> start(const Announcement& self, const DiscoveryOptions& options);
    ~Announcing(); // sends the final announcement

    // Return the reason why this daemon is not announced by beacon, or by Avahi; empty: it is.
    [[nodiscard]] std::string beaconTrouble() const;
    [[nodiscard]] std::string avahiTrouble() const { return publisher_ ? publisher_->trouble() : std::string(); }

private:
    Announcing(const Announcement& self, const DiscoveryOptions& options, FileDescriptor stop);
    void run();

    Announcement self_;
    DiscoveryOptions options_;
    FileDescriptor stop_; // readable: end
    std::unique_ptr<AvahiPublisher> publisher_;
    mutable std::mutex mutex_;
    std::string trouble_;
    std::thread thread_;
};

} // namespace mural
