// Objects and messages in the texts of errors.
#pragma once

#include <string>

#include "common/base/result.hpp"
#include "objects/wire/messages.hpp"

namespace mural::objects {

// Returns: object "camera" (Scene).
inline std::string describe(const ShareMessage& share) {
    const std::string name = share.name.empty() ? "number " + std::to_string(share.number) : '"' + share.name + '"';
    return "object " + name + " (" + share.typeName + ")";
}

inline Error damagedMessage(std::span<const std::byte> bytes) {
    const char* const kind = bytes.empty() ? "empty" : nameOf(static_cast<MessageKind>(bytes.front()));
    return {"a message of " + std::to_string(bytes.size()) + " bytes about objects is damaged (kind " + kind +
            "); it is ignored"};
}

inline Error unexpectedMessage(const Message& message, const char* receiver) {
    return {std::string("a message of kind ") + nameOf(static_cast<MessageKind>(message.index() + 1)) +
            " about objects is not for " + receiver + "; it is ignored"};
}

} // namespace mural::objects
