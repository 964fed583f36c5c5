// Texts of a group's options: rates, sizes, seals, secrets.
#pragma once

#include <string>

#include "common/result.hpp"
#include "transport/rsp/keys.hpp"
#include "transport/secure_channel.hpp"

namespace mural::rsp {

// "200mbit", "1gbit", "950kbit" (bits per second), "25MB" (bytes per second), "0": bytes per second.
Result<double> parseRate(const std::string& text);
// "1000000", "64k", "256M", "2G": bytes, in steps of 1024.
Result<uint64_t> parseSize(const std::string& text);
// As nameOf tells them; "auto": the fastest encryption of this machine.
Result<Seal> parseSeal(const std::string& text);
// Of a file with at least 16 bytes that not every user of the machine can read or write, "-": standard input. All of it counts but a line end at its end.
Result<ChannelSecret> readSecret(const std::string& path);

} // namespace mural::rsp
