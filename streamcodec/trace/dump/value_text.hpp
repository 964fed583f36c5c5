// Formats values of records.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "streamcodec/command_parameters.hpp"

namespace mural::trace {

std::string enumText(uint16_t group, uint32_t value);
std::string bitsText(uint16_t group, uint32_t value);
std::string numberText(Element element, uint16_t group, const std::byte* at);
// Returns the first elements and the total size.
std::string arrayText(Element element, uint16_t group, std::span<const std::byte> bytes);
// Returns a quoted text, truncated if it is long.
std::string quoted(std::span<const std::byte> bytes);

} // namespace mural::trace
