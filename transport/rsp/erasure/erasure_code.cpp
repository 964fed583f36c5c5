#include "transport/rsp/erasure/erasure_code.hpp"

#include <array>

#include <isa-l/erasure_code.h>

#include "common/base/copy_bytes.hpp"
#include "common/base/little_endian.hpp"

namespace mural::rsp {

namespace {

constexpr size_t kTableBytes = 32; // ISA-L's products of one factor with every half of a byte
using FactorTable = std::array<uint8_t, kTableBytes>;

// Columns use the field's elements 0 to 31, rows 32 to 255.
uint8_t cauchy(int row, int column) { return gf_inv(static_cast<uint8_t>((row + kMaxInGroup) ^ column)); }

std::array<FactorTable, 256> makeTables() {
    std::array<FactorTable, 256> tables{};
    for (size_t factor = 0; factor < tables.size(); ++factor) {
        auto matrix = static_cast<uint8_t>(factor);
        ec_init_tables(1, 1, &matrix, tables[factor].data()); // in the layout of the instructions that ISA-L selects
    }
    return tables;
}

// ISA-L does not write through these pointers, although their types permit it.
uint8_t* bytesOf(std::span<const std::byte> bytes) {
    return reinterpret_cast<uint8_t*>(const_cast<std::byte*>(bytes.data()));
}

// Computes into[i] ^= factor * from[i] for all of `from`.
void multiplyAdd(std::span<std::byte> into, std::span<const std::byte> from, uint8_t factor) {
    static const std::array<FactorTable, 256> tables = makeTables();
    FactorTable table = tables[factor];
    uint8_t* to = bytesOf(into);
    ec_encode_data_update(static_cast<int>(from.size()), 1, 1, 0, table.data(), bytesOf(from), &to);
}

} // namespace

uint8_t codeFactor(int row, int column) { return gf_mul(cauchy(row, column), gf_inv(cauchy(0, column))); }

void addSymbol(std::span<std::byte> rowSymbol, int row, int column, std::span<const std::byte> payload) {
    const uint8_t factor = codeFactor(row, column);
    std::array<std::byte, kLengthBytes> length;
    storeLittle(length.data(), static_cast<uint16_t>(payload.size()));
    multiplyAdd(rowSymbol, length, factor);
    multiplyAdd(rowSymbol.subspan(kLengthBytes), payload, factor);
}

void solveMissing(std::span<const int> missing, std::span<HeldRow> rows, std::vector<std::byte>& scratch) {
    const size_t n = missing.size();
    const size_t bytes = rows[0].symbol.size();
    const auto count = static_cast<int>(n);
    std::vector<uint8_t> matrix(n * n);
    for (size_t r = 0; r < n; ++r)
        for (size_t c = 0; c < n; ++c) matrix[r * n + c] = codeFactor(rows[r].row, missing[c]);
    std::vector<uint8_t> inverse(n * n);
    gf_invert_matrix(matrix.data(), inverse.data(), count); // cannot fail: the matrix is regular

    std::vector<uint8_t> tables(n * n * kTableBytes);
    ec_init_tables(count, count, inverse.data(), tables.data());
    scratch.resize(n * bytes);
    std::vector<uint8_t*> from(n);
    std::vector<uint8_t*> to(n);
    for (size_t i = 0; i < n; ++i) {
        from[i] = bytesOf(rows[i].symbol);
        to[i] = bytesOf(std::span(scratch).subspan(i * bytes, bytes));
    }
    ec_encode_data(static_cast<int>(bytes), count, count, tables.data(), from.data(), to.data());
    for (size_t c = 0; c < n; ++c) copyBytes(std::span(scratch).subspan(c * bytes, bytes), rows[c].symbol);
}

} // namespace mural::rsp
