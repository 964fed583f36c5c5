#include "transport/discovery/node_table.hpp"

#include <algorithm>

namespace mural {

namespace {
void addAddress(FoundNode& node, const std::string& address) {
    if (address.empty() || node.addresses.size() >= NodeTable::kMaxAddresses) return;
    if (std::ranges::find(node.addresses, address) == node.addresses.end()) node.addresses.push_back(address);
}
} // namespace

NodeTable::Entry* NodeTable::entry(const Announcement& a) {
    const auto found = entries_.find(a.uuid);
    if (found == entries_.end() && entries_.size() >= kMaxNodes) return nullptr;
    Entry& e = found == entries_.end() ? entries_[a.uuid] : found->second;
    // The node may have restarted elsewhere: its latest announcement counts.
    if (e.node.port != a.port) e.node.addresses.clear();
    e.node.uuid = a.uuid;
    e.node.name = a.name;
    e.node.version = a.version;
    e.node.port = a.port;
    return &e;
}

void NodeTable::onBeacon(const Announcement& a, const std::string& from, int64_t nowNs) {
    if (a.kind == AnnouncementKind::Gone) {
        if (const auto found = entries_.find(a.uuid); found != entries_.end()) {
            found->second.node.byBeacon = false;
            remove(found);
        }
        return;
    }
    if (a.kind != AnnouncementKind::Here) return;
    Entry* e = entry(a);
    if (!e) return;
    e->node.byBeacon = true;
    e->receivedNs = nowNs;
    addAddress(e->node, from);
}

void NodeTable::foundByAvahi(const Announcement& a, const std::string& address) {
    Entry* e = entry(a);
    if (!e) return;
    e->node.byAvahi = true;
    addAddress(e->node, address);
}

void NodeTable::lostByAvahi(const Uuid& uuid) {
    const auto found = entries_.find(uuid);
    if (found == entries_.end()) return;
    found->second.node.byAvahi = false;
    remove(found);
}

// Removes a node unless the other method still finds it.
void NodeTable::remove(std::map<Uuid, Entry>::iterator at) {
    if (!at->second.node.byBeacon && !at->second.node.byAvahi) entries_.erase(at);
}

void NodeTable::expire(int64_t nowNs) {
    for (auto at = entries_.begin(); at != entries_.end();) {
        const auto next = std::next(at);
        if (at->second.node.byBeacon && nowNs - at->second.receivedNs > kSilentNs) {
            at->second.node.byBeacon = false;
            remove(at);
        }
        at = next;
    }
}

std::vector<FoundNode> NodeTable::nodes() const {
    std::vector<FoundNode> all;
    for (const auto& [uuid, e] : entries_) all.push_back(e.node);
    std::ranges::stable_sort(all, {}, &FoundNode::name);
    return all;
}

} // namespace mural
