// What the suite prints at its end: each case with what it was held against, how far off it was, and the most it may be.
#pragma once

#include <string>

namespace mural::numerics {

// A case that was measured: fails the test where it is off by more than `most`. The worst of several with one name stands in the table.
void expectWithin(const std::string& what, const std::string& against, double off, double most, const std::string& unit);
// A case that is exact, or refused as it must be.
void expectThat(const std::string& what, const std::string& against, bool holds, const std::string& result);

} // namespace mural::numerics
