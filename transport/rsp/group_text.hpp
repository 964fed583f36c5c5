// Parses options of a group: rates, sizes, seals, secrets.
#pragma once

#include <string>

#include "common/base/result.hpp"
#include "transport/rsp/wire/keys.hpp"
#include "transport/secure/secure_channel.hpp"

namespace mural::rsp {

// "200mbit", "1gbit", "950kbit" (bits per second), "25MB" (bytes per second), "0". Result in bytes per second.
Result<double> parseRate(const std::string& text);
// "1000000", "64k", "256M", "2G": bytes, with binary prefixes.
Result<uint64_t> parseSize(const std::string& text);
// Names of nameOf(), or "auto": the fastest encryption of this machine.
Result<Seal> parseSeal(const std::string& text);
// Reads a file of at least 16 bytes that not every user may access, or standard input ("-"). A final line end does not
// count.
Result<ChannelSecret> readSecret(const std::string& path);

} // namespace mural::rsp
