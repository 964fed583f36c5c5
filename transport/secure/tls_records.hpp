// The boundaries of TLS records in a byte stream. They tell a reader how many bytes complete the current record, so
// that it requests no byte of the next one.
#pragma once

#include <cstddef>
#include <span>

namespace mural {

class TlsRecords {
public:
    // Returns false if the bytes can't be a stream of TLS records.
    bool advance(std::span<const std::byte> bytes);
    // Returns the number of bytes that complete the current record or its header.
    [[nodiscard]] size_t missingBytes() const { return bodyBytes_ > 0 ? bodyBytes_ : kHeaderBytes - headerBytes_; }

private:
    static constexpr size_t kHeaderBytes = 5; // type, version (2), length (2)
    static constexpr size_t kMaxBodyBytes = 16'384 + 256;

    size_t headerBytes_ = 0; // read bytes of the header
    size_t lengthBytes_ = 0; // the body's length, as far as it is read
    size_t bodyBytes_ = 0;   // unread bytes of the body
};

} // namespace mural
