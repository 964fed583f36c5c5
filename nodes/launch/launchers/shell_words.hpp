// Words of commands, for shells of other machines and for messages.
#pragma once

#include <string>
#include <vector>

namespace mural::launch {

// Quotes a word for a POSIX shell, unless every shell reads it as it is.
std::string quoted(const std::string& word);
// Splits at white space; there is no quoting.
std::vector<std::string> wordsOf(const std::string& text);
std::string joined(const std::vector<std::string>& words, const char* separator);

} // namespace mural::launch
