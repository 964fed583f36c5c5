#include "objects/wire/message_parts.hpp"

#include <algorithm>

namespace mural::objects {

namespace {

constexpr size_t kPartOverheadBytes = 2; // kind and flag

} // namespace

void cutMessage(std::span<const std::byte> message, size_t mostBytes,
                const std::function<void(std::span<const std::byte>)>& emit) {
    if (message.size() <= mostBytes) return emit(message);
    archive::ByteBuffer buffer;
    while (!message.empty()) {
        const auto part = message.first(std::min(message.size(), mostBytes - kPartOverheadBytes));
        message = message.subspan(part.size());
        buffer.clear();
        encodeInto(buffer, PartMessage{message.empty(), part});
        emit(buffer.bytes());
    }
}

Result<std::optional<std::span<const std::byte>>> MessageJoiner::input(std::span<const std::byte> message) {
    using Whole = std::optional<std::span<const std::byte>>;
    if (std::exchange(isReturned_, false)) joined_ = {};
    const bool isPart = !message.empty() && static_cast<MessageKind>(message.front()) == MessageKind::Part;
    const auto decoded = isPart ? decode(message) : std::nullopt;
    if ((isPart && !decoded) || (!isPart && isOpen_)) {
        isOpen_ = false;
        joined_ = {};
        return Error{"a message about objects arrived without its last parts; it is dropped"};
    }
    if (!isPart) return Whole(message);
    const auto& part = std::get<PartMessage>(*decoded);
    joined_.insert(joined_.end(), part.bytes.begin(), part.bytes.end());
    isOpen_ = !part.isLast;
    if (isOpen_) return Whole();
    isReturned_ = true;
    return Whole(std::span<const std::byte>(joined_));
}

} // namespace mural::objects
