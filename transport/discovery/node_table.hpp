// Discovered nodes, merged from all methods. Has no sockets or clock.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "transport/discovery/announcement.hpp"

namespace mural {

struct FoundNode {
    Uuid uuid{};
    std::string name;
    std::string version;
    uint16_t port = 0;
    std::vector<std::string> addresses; // in order of arrival; link-local IPv6 addresses with "%eth0"
    bool byBeacon = false;
    bool byAvahi = false;
};

class NodeTable {
public:
    // Timeout of a beacon.
    static constexpr int64_t kSilentNs = 3'500'000'000;
    // Limit against floods of forged announcements.
    static constexpr size_t kMaxNodes = 1024;
    static constexpr size_t kMaxAddresses = 16;

    void onBeacon(const Announcement& a, const std::string& from, int64_t nowNs);
    void foundByAvahi(const Announcement& a, const std::string& address);
    void lostByAvahi(const Uuid& uuid);
    void expire(int64_t nowNs);

    // Sorted by name, then UUID.
    [[nodiscard]] std::vector<FoundNode> nodes() const;

private:
    struct Entry {
        FoundNode node;
        int64_t receivedNs = 0;
    };
    Entry* entry(const Announcement& a);
    void remove(std::map<Uuid, Entry>::iterator at);
    std::map<Uuid, Entry> entries_;
};

} // namespace mural
