#include "transport/rsp/erasure/erasure_code.hpp"

#include <algorithm>
#include <array>

#include "common/base/copy_bytes.hpp"
#include "common/base/little_endian.hpp"
#include "transport/rsp/erasure/gf256.hpp"

namespace mural::rsp {

namespace {

// Columns use the field's elements 0 to 31, rows 32 to 255.
constexpr uint8_t cauchy(int row, int column) {
    return gf256::inverse(static_cast<uint8_t>((row + kMaxInGroup) ^ column));
}

using Matrix = std::array<std::array<uint8_t, kMaxInGroup>, kMaxInGroup>;

void scaleRow(std::array<uint8_t, kMaxInGroup>& row, uint8_t factor) {
    for (uint8_t& value : row) value = gf256::multiply(value, factor);
}

void addRow(std::array<uint8_t, kMaxInGroup>& into, const std::array<uint8_t, kMaxInGroup>& from, uint8_t factor) {
    for (size_t i = 0; i < into.size(); ++i) into[i] ^= gf256::multiply(from[i], factor);
}

// Gauss-Jordan elimination. The matrix is regular, so a pivot exists.
Matrix invert(Matrix m, size_t n) {
    Matrix result{};
    for (size_t i = 0; i < n; ++i) result[i][i] = 1;
    for (size_t column = 0; column < n; ++column) {
        size_t pivot = column;
        while (m[pivot][column] == 0) ++pivot;
        std::swap(m[pivot], m[column]);
        std::swap(result[pivot], result[column]);
        const uint8_t scale = gf256::inverse(m[column][column]);
        scaleRow(m[column], scale);
        scaleRow(result[column], scale);
        for (size_t row = 0; row < n; ++row) {
            const uint8_t factor = m[row][column];
            if (row == column || factor == 0) continue;
            addRow(m[row], m[column], factor);
            addRow(result[row], result[column], factor);
        }
    }
    return result;
}

} // namespace

uint8_t codeFactor(int row, int column) {
    return gf256::multiply(cauchy(row, column), gf256::inverse(cauchy(0, column)));
}

void addSymbol(std::span<std::byte> rowSymbol, int row, int column, std::span<const std::byte> payload) {
    const uint8_t factor = codeFactor(row, column);
    std::array<std::byte, kLengthBytes> length;
    storeLittle(length.data(), static_cast<uint16_t>(payload.size()));
    gf256::multiplyAdd(rowSymbol, length, factor);
    gf256::multiplyAdd(rowSymbol.subspan(kLengthBytes), payload, factor);
}

void solveMissing(std::span<const int> missing, std::span<HeldRow> rows, std::vector<std::byte>& scratch) {
    const size_t n = missing.size();
    const size_t bytes = rows[0].symbol.size();
    Matrix m{};
    for (size_t r = 0; r < n; ++r)
        for (size_t c = 0; c < n; ++c) m[r][c] = codeFactor(rows[r].row, missing[c]);
    const Matrix inverse = invert(m, n);

    scratch.assign(n * bytes, std::byte{0});
    for (size_t c = 0; c < n; ++c) {
        const auto symbol = std::span(scratch).subspan(c * bytes, bytes);
        for (size_t r = 0; r < n; ++r) gf256::multiplyAdd(symbol, rows[r].symbol, inverse[c][r]);
    }
    for (size_t c = 0; c < n; ++c) copyBytes(std::span(scratch).subspan(c * bytes, bytes), rows[c].symbol);
}

} // namespace mural::rsp
