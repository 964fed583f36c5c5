#include "transport/discovery/announcer.hpp"

#include <algorithm>

namespace mural {

void Announcer::onAnnouncement(const Announcement& a, int64_t nowNs) {
    if (a.kind != AnnouncementKind::Search) return;
    const int64_t answerNs = nowNs + static_cast<int64_t>(random_() % static_cast<uint64_t>(kMaxAnswerNs));
    dueNs_ = std::min(dueNs_, std::max(answerNs, sentNs_ + kMinBetweenNs));
}

int64_t Announcer::tick(int64_t nowNs, const std::function<void(std::span<const std::byte>)>& broadcast) {
    if (nowNs >= dueNs_) {
        broadcast(encode(self_));
        sentNs_ = nowNs;
        dueNs_ = nowNs + kEveryNs;
    }
    return dueNs_;
}

std::vector<std::byte> Announcer::farewell() const {
    Announcement last = self_;
    last.kind = AnnouncementKind::Gone;
    return encode(last);
}

} // namespace mural
