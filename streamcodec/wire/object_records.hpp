// Messages about distributed objects in the stream of a program with the native API (kOpObject). A message may be
// longer than a packet. It then occupies several records, and each states how many bytes follow in later ones.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/record.hpp"

namespace mural::wire {

constexpr size_t kObjectPieceBytes = size_t{128} << 10; // of one record
constexpr uint32_t kMaxObjectBytes = 1U << 30;          // of one message

// The thread of the program's stream (wire::streamOf) selects the receivers: the head sends packets of kToAllNodes to
// all nodes, and packets of toNode(n) to node n only.
constexpr uint16_t kToAllNodes = 0;
constexpr uint32_t kMaxAddressedNode = 0xfffe;
constexpr uint16_t toNode(uint32_t node) { return static_cast<uint16_t>(node + 1); }

// Calls add(record) for each record of a message. Requires at most kMaxObjectBytes.
template <class Add> void splitIntoRecords(std::span<const std::byte> message, Add&& add) {
    std::vector<std::byte> record;
    do {
        const size_t count = std::min(message.size(), kObjectPieceBytes);
        const auto piece = message.first(count);
        message = message.subspan(count);
        const auto following = static_cast<uint32_t>(message.size());
        const auto length = static_cast<uint32_t>(count);
        const size_t words = 4 + (count + 3) / 4; // header in long form, then `following`, `length`, bytes
        record.assign(words * 4, std::byte{0});
        const uint32_t head[4] = {uint32_t{kOpObject} | record::kLongForm << 16, static_cast<uint32_t>(words),
                                  following, length};
        std::memcpy(record.data(), head, sizeof head);
        if (count > 0) std::memcpy(record.data() + sizeof head, piece.data(), count);
        add(std::span<const std::byte>(record));
    } while (!message.empty());
}

// Joins the records of messages with the same receivers.
class ObjectRecordJoiner {
public:
    // Takes the arguments of a record. Returns false, and drops the message in progress, if they are malformed, or if
    // an earlier record of the message is missing.
    bool add(std::span<const std::byte> arguments) {
        uint32_t words[2] = {};
        if (isComplete_) drop();
        if (arguments.size() < sizeof words) return drop();
        std::memcpy(words, arguments.data(), sizeof words);
        arguments = arguments.subspan(sizeof words);
        const uint64_t following = words[0], length = words[1];
        const bool continues = following_ > 0;
        if (length > arguments.size() || bytes_.size() + length + following > kMaxObjectBytes) return drop();
        if (continues && length + following != following_) return drop();
        bytes_.insert(bytes_.end(), arguments.begin(), arguments.begin() + static_cast<std::ptrdiff_t>(length));
        following_ = following;
        isComplete_ = following == 0;
        return true;
    }
    // Whether message() is complete.
    [[nodiscard]] bool isComplete() const { return isComplete_; }
    // Valid until the next add().
    [[nodiscard]] std::span<const std::byte> message() const { return bytes_; }

private:
    bool drop() {
        bytes_.clear();
        following_ = 0;
        isComplete_ = false;
        return false;
    }

    std::vector<std::byte> bytes_;
    uint64_t following_ = 0; // bytes of the message that are missing
    bool isComplete_ = false;
};

} // namespace mural::wire
