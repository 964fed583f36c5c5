#include "nodes/head/control/nearest_names.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace mural {
namespace {

constexpr size_t kMaxNearest = 3;
constexpr size_t kMaxWordBytes = 64;

// Returns the number of inserted, removed and replaced characters (Levenshtein 1966), with one row of the table.
size_t editsBetween(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = std::exchange(row[0], i);
        for (size_t k = 1; k <= b.size(); ++k) {
            const size_t replaced = diagonal + (a[i - 1] == b[k - 1] ? 0 : 1);
            diagonal = std::exchange(row[k], std::min({row[k] + 1, row[k - 1] + 1, replaced}));
        }
    }
    return row.back();
}

bool isSimilar(std::string_view word, std::string_view name, size_t edits) {
    return edits <= std::max<size_t>(2, name.size() / 3) || name.starts_with(word) || word.starts_with(name);
}

} // namespace

std::vector<std::string> nearestNames(std::string_view word, const std::vector<std::string>& names) {
    if (word.empty() || word.size() > kMaxWordBytes) return {};
    std::vector<std::pair<size_t, std::string>> similar;
    for (const std::string& name : names)
        if (const size_t edits = editsBetween(word, name); isSimilar(word, name, edits))
            similar.emplace_back(edits, name);
    std::ranges::sort(similar);
    similar.resize(std::min(similar.size(), kMaxNearest));
    std::vector<std::string> nearest;
    for (auto& [edits, name] : similar) nearest.push_back(std::move(name));
    return nearest;
}

std::string joinNames(const std::vector<std::string>& names) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    return all;
}

} // namespace mural
