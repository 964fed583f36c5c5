// The table that the suite prints at its end: each case with reference, error and bound.
#pragma once

#include <string>

namespace mural::numerics {

// A measured case: fails the test if it is off by more than `maximum`. The table shows the worst of several cases with
// one name.
void expectWithin(const std::string& what, const std::string& against, double off, double maximum,
                  const std::string& unit);
// A case that is exact, or rejected as required.
void expectThat(const std::string& what, const std::string& against, bool holds, const std::string& result);

} // namespace mural::numerics
