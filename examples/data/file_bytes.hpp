// Files as bytes. Files compressed with gzip (RFC 1952) are decompressed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace mural::examples {

// Largest accepted size of a file's contents, in bytes. Bounds the memory that a damaged or hostile gzip file takes.
constexpr uint64_t kMaxFileBytes = uint64_t{16} << 30;

// Returns the contents of a file, decompressed if they begin as gzip. Errors: the file is not readable, is damaged, or
// holds more than `maxBytes`.
Result<std::string> readFile(const std::string& path, uint64_t maxBytes = kMaxFileBytes);

[[nodiscard]] bool isGzip(std::string_view bytes);
// Returns the decompressed contents of one or more gzip members. `file` is the name in errors. Memory grows with the
// contents that exist, not with a stated length.
Result<std::string> gunzip(std::string_view bytes, const std::string& file, uint64_t maxBytes = kMaxFileBytes);

} // namespace mural::examples
