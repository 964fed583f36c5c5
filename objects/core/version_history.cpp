#include "objects/core/version_history.hpp"

#include <algorithm>
#include <iterator>

namespace mural::objects {

bool VersionHistory::add(Version version, uint64_t frame, StatePointer state) {
    auto at = entries_.end();
    while (at != entries_.begin() && std::prev(at)->version >= version) --at;
    if (at == entries_.end() || at->version != version) {
        if (at != entries_.end()) frame = std::min(frame, at->frame);
        entries_.insert(at, {version, frame, std::move(state)});
        return true;
    }
    if (at->state || !state) return false;
    at->state = std::move(state);
    return true;
}

void VersionHistory::announce(Version version, uint64_t frame) {
    add(version, frame, nullptr);
    for (Entry& entry : entries_)
        if (entry.version <= version && entry.frame == kNotAnnounced) entry.frame = frame;
}

void VersionHistory::trim(uint64_t finishedFrame, uint32_t kept) {
    // The first entry that a later frame uses: the last one with frame <= finishedFrame + 1, since it also serves that
    // frame.
    size_t firstUsed = 0;
    for (size_t i = 1; i < entries_.size() && entries_[i].frame <= finishedFrame + 1; ++i) firstUsed = i;
    size_t newestState = entries_.size();
    for (size_t i = entries_.size(); i-- > 0 && newestState == entries_.size();)
        if (entries_[i].state) newestState = i;
    size_t drop = firstUsed > kept ? firstUsed - kept : 0;
    drop = std::min(drop, newestState);
    entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(drop));
}

void VersionHistory::keepNewest() {
    for (size_t i = entries_.size(); i-- > 0;) {
        if (!entries_[i].state) continue;
        entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(i));
        return;
    }
    if (entries_.size() > 1) entries_.erase(entries_.begin(), entries_.end() - 1);
}

StatePointer VersionHistory::newestState() const {
    for (size_t i = entries_.size(); i-- > 0;)
        if (entries_[i].state) return entries_[i].state;
    return nullptr;
}

StatePointer VersionHistory::at(Version version) const {
    const auto found = std::lower_bound(entries_.begin(), entries_.end(), version,
                                        [](const Entry& entry, Version wanted) { return entry.version < wanted; });
    return found != entries_.end() && found->version == version ? found->state : nullptr;
}

Version VersionHistory::versionAtFrame(uint64_t frame) const {
    Version version = 0;
    for (const Entry& entry : entries_) {
        if (entry.frame > frame) break;
        version = entry.version;
    }
    return version;
}

} // namespace mural::objects
