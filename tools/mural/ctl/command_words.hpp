// The words of `mural ctl`: a session, and one request. Pure.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural::cli {

// True for "4711", "mural-4711-00112233aabbccdd" and the path of a control socket.
bool namesSession(const std::string& word);

struct CommandRequest {
    std::string operation;
    nlohmann::json arguments = nlohmann::json::object();
};

// Finds the operation whose usage fits the words. operations: the list that the operation `help` returns. Errors name
// the nearest operations, or the usage.
Result<CommandRequest> requestOf(const std::vector<std::string>& words, const nlohmann::json& operations);

// A word that may follow the words of a request.
struct NextWord {
    std::string word;      // fixed, or the name of the argument
    std::string kind;      // of the argument, such as "whole number"; empty: a fixed word
    std::string operation; // that the words begin
    std::string meaning;   // of the operation
};
// Returns the words that may follow `words`. operations: as for requestOf().
std::vector<NextWord> nextWords(const std::vector<std::string>& words, const nlohmann::json& operations);

} // namespace mural::cli
