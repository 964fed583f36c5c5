// Reed-Solomon: from k symbols, rows are made such that any k of symbols and rows together give all of them. The matrix
// is Cauchy's with its columns scaled so that row 0 is a plain sum (XOR); every square part of it can be inverted.
//
// A symbol is a datagram's payload behind its length (2 bytes), as if padded with zeros to the longest: a row covers
// lengths as well, and short datagrams cost only their bytes.
//
// Source: RFC 5510 for the principle (that code's matrix is another).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "transport/rsp/datagram.hpp"

namespace mural::rsp {

// What symbol `column` is multiplied by in `row`. column < kMostInGroup, row < kMostRows.
[[nodiscard]] uint8_t codeFactor(int row, int column);

// Adds one symbol to a row, which has kLengthBytes + payload.size() bytes at least and starts as zeros.
void addSymbol(std::span<std::byte> rowSymbol, int row, int column, std::span<const std::byte> payload);

// One row that came. While symbols are put back its bytes are changed.
struct HeldRow {
    int row;
    std::span<std::byte> symbol; // all of the same length within one call
};

// Solves for the missing columns. `rows`, as many as columns are missing, have had all present symbols added
// (addSymbol is its own inverse). Afterwards rows[i].symbol holds the symbol of missing[i].
void solveMissing(std::span<const int> missing, std::span<HeldRow> rows, std::vector<std::byte>& scratch);

} // namespace mural::rsp
