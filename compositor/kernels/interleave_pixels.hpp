// Interleaves pixels of parts with every n-th column into a row, and extracts them.
#pragma once

#include <cstddef>

namespace mural::compositor {

// Copies part[i] to row[i * step]. pixelBytes: 4, 8 or 16. Writes nothing after the last pixel.
void interleaveRow(std::byte* row, const std::byte* part, size_t count, size_t step, size_t pixelBytes);
// Copies row[i * step] to part[i].
void deinterleaveRow(std::byte* part, const std::byte* row, size_t count, size_t step, size_t pixelBytes);
// Interleaves all `step` parts in one pass: row[i * step + k] = parts[k][i]. 4 bytes per pixel.
void interleaveParts(std::byte* row, const std::byte* const* parts, size_t count, size_t step);

void interleaveRowScalar(std::byte* row, const std::byte* part, size_t count, size_t step, size_t pixelBytes);

} // namespace mural::compositor
