// Finds the names that a mistyped word probably means.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mural {

// Returns at most three of `names`, the most similar first. Similar: few edits, or one begins with the other. Long
// words have no similar names.
std::vector<std::string> nearestNames(std::string_view word, const std::vector<std::string>& names);

// Returns "a, b, c".
std::string joinNames(const std::vector<std::string>& names);

} // namespace mural
