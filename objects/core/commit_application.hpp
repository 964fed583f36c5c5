// Applies received commits to states.
#pragma once

#include <functional>

#include "objects/core/object_state.hpp"

namespace mural::objects {

// Returns the state after a commit, or null if the message does not fit: slots beyond the object's, or not all slots
// without a base. `base` is the state of message.base; null for base 0. entryFor(ref) returns the entry of a blob.
StatePointer stateAfter(const CommitMessage& message, const ObjectState* base, uint32_t slotCount,
                        const std::function<std::shared_ptr<BlobEntry>(const BlobRef&)>& entryFor);

} // namespace mural::objects
