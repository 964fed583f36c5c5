// Reed-Solomon erasure code: from k symbols it makes parity symbols such that any k of all symbols restore the rest.
// The matrix is a Cauchy matrix with columns scaled so that row 0 is a plain XOR. Every square submatrix is regular.
//
// A symbol is the length of a datagram's payload (2 bytes) and the payload, as if zero-padded to the longest. Parity
// symbols thus cover lengths too, and short datagrams cost only their own bytes.
//
// The field is GF(2^8) over x^8 + x^4 + x^3 + x^2 + 1. ISA-L does its arithmetic with the vector instructions of the
// machine.
//
// Source: RFC 5510 for the principle, with another matrix.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "transport/rsp/wire/datagram.hpp"

namespace mural::rsp {

// Returns the coefficient of symbol `column` in parity symbol `row`. Requires column < kMaxInGroup and row <
// kMaxRows.
[[nodiscard]] uint8_t codeFactor(int row, int column);

// Adds one symbol to a parity symbol, which starts as zeros and has at least kLengthBytes + payload.size() bytes.
void addSymbol(std::span<std::byte> rowSymbol, int row, int column, std::span<const std::byte> payload);

// A received parity symbol. Decoding overwrites its bytes.
struct HeldRow {
    int row;
    std::span<std::byte> symbol; // all of equal length within one call
};

// Solves for the missing columns. Requires as many `rows` as missing columns, to which all present symbols have been
// added (addSymbol is its own inverse). Afterwards rows[i].symbol is the symbol of missing[i].
void solveMissing(std::span<const int> missing, std::span<HeldRow> rows, std::vector<std::byte>& scratch);

} // namespace mural::rsp
