#include "streamcodec/delta/dictionary.hpp"

#include <algorithm>

namespace mural::delta {

Dictionary::Opened Dictionary::open(uint32_t stream) {
    ++opened_;
    for (size_t place = 0; place < streams_.size(); ++place) {
        if (streams_[place].stream != stream) continue;
        streams_[place].usedAt = opened_;
        return {place, false};
    }
    size_t place = streams_.size();
    if (place < limits_.streams)
        streams_.emplace_back();
    else
        place = static_cast<size_t>(std::ranges::min_element(streams_, {}, &Stream::usedAt) - streams_.begin());
    streams_[place] = {stream, opened_, first_ ? std::move(first_) : std::make_unique<EntryLog>(limits_.logItems)};
    return {place, true};
}

} // namespace mural::delta
