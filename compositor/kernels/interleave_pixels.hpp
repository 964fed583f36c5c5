// Pixels of a picture drawn in parts of every n-th column, put back into their row, and taken out of it.
#pragma once

#include <cstddef>

namespace mural::compositor {

// part[i] goes to row[i * step]; `row` stands at the first. pixelBytes: 4, 8 or 16. Nothing behind the last pixel is written.
void interleaveRow(std::byte* row, const std::byte* part, size_t count, size_t step, size_t pixelBytes);
// part[i] = row[i * step].
void deinterleaveRow(std::byte* part, const std::byte* row, size_t count, size_t step, size_t pixelBytes);
// All `step` parts of a row at once, which writes each byte once: row[i * step + k] = parts[k][i]. 4 bytes per pixel.
void interleaveParts(std::byte* row, const std::byte* const* parts, size_t count, size_t step);

void interleaveRowScalar(std::byte* row, const std::byte* part, size_t count, size_t step, size_t pixelBytes);

} // namespace mural::compositor
