#include "streamcodec/filter/object.hpp"

#include <algorithm>

namespace mural::filter {
namespace {

constexpr size_t kMaxKnown = 32;
constexpr size_t kMaxExamined = 64; // examined entries at the end of the queue

} // namespace

Object::Comparison Object::compare(const Upload& u, bool first, const std::function<Sum()>& sum) {
    Comparison comparison = Comparison::First;
    std::optional<Sum> now;
    for (const Known& k : known) {
        if (!(k.shape == u.shape)) continue;
        if (!now) now = sum();
        if (k.sum == now) return Comparison::Same;
        if (k.sum) comparison = Comparison::Changed;
    }
    forgets(u);
    if (known.size() == kMaxKnown) known.clear();
    if (!now && !first) now = sum();
    known.push_back({u.place, u.shape, now});
    return comparison;
}

void Object::forgets(const Upload& u) {
    if (u.kind == UploadKind::Storage) return known.clear();
    std::erase_if(known, [&](const Known& k) { return k.place.overlaps(u.place); });
}

Object::Replaced Object::replaces(const Upload& u) {
    Replaced gone;
    if (u.kind == UploadKind::Storage || !u.given) return gone;
    size_t at = queue.size();
    for (size_t examined = 0; at > 0 && examined < kMaxExamined; ++examined) {
        const Item& item = queue[--at];
        if (item.barrier) return gone;
        if (!item.isUpload || !(item.shape == u.shape)) continue;
        // Uploads of one shape are both valid or both invalid: the first has no visible effect, nor do intermediate
        // changes of an area that is completely overwritten.
        const auto stays = [&](const Item& i) {
            return &i != &item && !(u.kind == UploadKind::Whole && i.isUpload && i.place.overlaps(u.place));
        };
        std::vector<Item> left(std::make_move_iterator(queue.begin()),
                               std::make_move_iterator(queue.begin() + static_cast<std::ptrdiff_t>(at)));
        for (size_t i = at; i < queue.size(); ++i) {
            if (stays(queue[i])) {
                left.push_back(std::move(queue[i]));
                continue;
            }
            gone.records += queue[i].records;
            gone.sizeBytes += queue[i].bytes.size();
        }
        queue = std::move(left);
        deferredBytes -= gone.sizeBytes;
        gained = true;
        return gone;
    }
    return gone;
}

} // namespace mural::filter
