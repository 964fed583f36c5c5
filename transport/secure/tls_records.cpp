#include "transport/secure/tls_records.hpp"

#include <algorithm>

namespace mural {

bool TlsRecords::advance(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        if (bodyBytes_ > 0) {
            const size_t n = std::min(bodyBytes_, bytes.size());
            bodyBytes_ -= n;
            bytes = bytes.subspan(n);
            continue;
        }
        const auto value = std::to_integer<unsigned>(bytes.front());
        bytes = bytes.subspan(1);
        if (headerBytes_ == 0 && (value < 20 || value > 23)) return false; // change_cipher_spec to application_data
        if (headerBytes_ == 1 && value != 3) return false;                 // the major version of every TLS record
        if (headerBytes_ >= 3) lengthBytes_ = lengthBytes_ << 8 | value;
        if (++headerBytes_ < kHeaderBytes) continue;
        if (lengthBytes_ == 0 || lengthBytes_ > kMaxBodyBytes) return false;
        bodyBytes_ = lengthBytes_;
        headerBytes_ = lengthBytes_ = 0;
    }
    return true;
}

} // namespace mural
