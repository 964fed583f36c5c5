// Makes the corpus: bin/trace_fuzz_seeds RECORDING OUT NAME. It writes OUT/NAME_entries (small entries of the first
// block) and OUT/NAME_file (the rest of the file after the header).
#include <cstdio>
#include <fstream>
#include <string>

#include "streamcodec/trace/trace_reader.hpp"

namespace {

constexpr size_t kMaxBytes = 32768;

void save(const std::string& path, std::span<const std::byte> bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 4) return std::fputs("trace_fuzz_seeds RECORDING OUT NAME\n", stderr), 2;
    auto reader = mural::trace::TraceReader::open(argv[1]);
    if (!reader) return std::fprintf(stderr, "%s\n", reader.error().message.c_str()), 1;
    const std::string name = std::string(argv[2]) + "/" + argv[3];
    const auto block = (*reader)->read(0);
    if (!block) return 1;
    size_t bytes = 0;
    mural::trace::EntryWalk walk(block.value());
    mural::trace::Entry entry;
    while (walk.next(entry) && bytes + mural::trace::entryBytes(entry.payload.size()) <= kMaxBytes)
        bytes += mural::trace::entryBytes(entry.payload.size());
    save(name + "_entries", block.value().first(bytes));
    std::ifstream file(argv[1], std::ios::binary);
    std::string whole((std::istreambuf_iterator<char>(file)), {});
    whole.erase(0, (*reader)->blocks().front().offset);
    if (whole.size() <= kMaxBytes) save(name + "_file", std::as_bytes(std::span(whole)));
    return 0;
}
