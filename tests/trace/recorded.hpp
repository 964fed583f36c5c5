// Streams and traces for tests: records of a program without draws, and in-memory files.
#pragma once

#include <cstdint>
#include <cstring>
#include <gtest/gtest.h>
#include <string>
#include <sys/mman.h>
#include <vector>

#include "streamcodec/trace/trace_reader.hpp"
#include "streamcodec/trace/trace_writer.hpp"
#include "streamcodec/registry_digest.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::trace {

using Bytes = std::vector<std::byte>;

// A packet, record by record.
class PacketBuilder {
public:
    PacketBuilder& record(uint16_t opcode, const std::vector<uint32_t>& arguments) {
        words_.push_back(opcode | static_cast<uint32_t>(arguments.size() + 1) << 16);
        words_.insert(words_.end(), arguments.begin(), arguments.end());
        return *this;
    }
    PacketBuilder& longRecord(uint16_t opcode, const std::vector<uint32_t>& arguments) {
        words_.push_back(opcode | 0xffff0000u);
        words_.push_back(static_cast<uint32_t>(arguments.size() + 2));
        words_.insert(words_.end(), arguments.begin(), arguments.end());
        return *this;
    }
    PacketBuilder& context(uint32_t context, uint32_t shareContext = 0) {
        std::vector<uint32_t> words(7 + sizeof(wire::WindowConfig) / 4, 0);
        words[0] = context;
        words[1] = shareContext;
        return record(wire::kOpCreateContext, words);
    }
    PacketBuilder& window(uint32_t window, uint32_t width, uint32_t height, uint8_t depth = 0) {
        wire::WindowConfig config{};
        config.width = width;
        config.height = height;
        config.red = config.green = config.blue = 8;
        config.depth = depth;
        config.doubleBuffer = 1;
        std::vector<uint32_t> words(1 + sizeof config / 4, window);
        std::memcpy(words.data() + 1, &config, sizeof config);
        return record(wire::kOpWindow, words);
    }
    PacketBuilder& swap(uint32_t window, uint32_t frame) { return record(wire::kOpSwap, {window, frame}); }
    PacketBuilder& append(const PacketBuilder& other) {
        words_.insert(words_.end(), other.words_.begin(), other.words_.end());
        return *this;
    }
    [[nodiscard]] std::span<const std::byte> bytes() const { return std::as_bytes(std::span(words_)); }

private:
    std::vector<uint32_t> words_;
};

inline Bytes readWhole(const std::string& path) {
    Bytes bytes;
    FILE* file = std::fopen(path.c_str(), "rb");
    if (file == nullptr) return bytes;
    std::byte buffer[65536];
    for (size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, file)) > 0;)
        bytes.insert(bytes.end(), buffer, buffer + n);
    std::fclose(file);
    return bytes;
}

inline Result<std::unique_ptr<TraceReader>> readerOf(std::span<const std::byte> bytes) {
    FileDescriptor file(memfd_create("recording", MFD_CLOEXEC));
    if (write(file.get(), bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
        return Error{"no memory for the file"};
    return TraceReader::open(std::move(file), "in memory");
}

struct Written {
    uint32_t stream = 0;
    uint64_t timeNs = 0;
    Bytes payload;
    bool operator==(const Written&) const = default;
};

// All entries up to the first unreadable block.
inline std::vector<Written> entriesOf(TraceReader& reader, std::string* problem = nullptr) {
    std::vector<Written> entries;
    for (size_t i = 0; i < reader.blocks().size(); ++i) {
        auto block = reader.read(i);
        if (!block) {
            if (problem != nullptr) *problem = block.error().message;
            return entries;
        }
        EntryWalk walk(*block);
        Entry entry;
        while (walk.next(entry))
            entries.push_back({entry.stream, entry.timeNs, Bytes(entry.payload.begin(), entry.payload.end())});
    }
    return entries;
}

} // namespace mural::trace
