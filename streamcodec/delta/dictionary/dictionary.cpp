#include "streamcodec/delta/dictionary/dictionary.hpp"

#include <algorithm>

namespace mural::delta {

Dictionary::Opened Dictionary::open(uint32_t stream) {
    ++opened_;
    for (size_t logIndex = 0; logIndex < streams_.size(); ++logIndex) {
        if (streams_[logIndex].stream != stream) continue;
        streams_[logIndex].usedAt = opened_;
        return {logIndex, false};
    }
    size_t logIndex = streams_.size();
    if (logIndex < limits_.streams)
        streams_.emplace_back();
    else
        logIndex = static_cast<size_t>(std::ranges::min_element(streams_, {}, &Stream::usedAt) - streams_.begin());
    streams_[logIndex] = {stream, opened_, first_ ? std::move(first_) : std::make_unique<EntryLog>(limits_.logItems)};
    return {logIndex, true};
}

} // namespace mural::delta
