#include "nodes/launch/elf_check.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <gelf.h>
#include <memory>
#include <optional>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace mural::launch {

namespace {

constexpr size_t kHeadBytes = 512; // the kernel reads 256 bytes of a "#!" line

class File {
public:
    explicit File(const std::string& path) : fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
        if (fd_ >= 0 && elf_version(EV_CURRENT) != EV_NONE) elf_.reset(elf_begin(fd_, ELF_C_READ, nullptr));
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() {
        elf_.reset();
        if (fd_ >= 0) close(fd_);
    }
    [[nodiscard]] bool opened() const { return fd_ >= 0; }
    [[nodiscard]] std::string head() const {
        std::string bytes(kHeadBytes, '\0');
        const ssize_t n = pread(fd_, bytes.data(), bytes.size(), 0);
        bytes.resize(n > 0 ? static_cast<size_t>(n) : 0);
        return bytes;
    }
    // Returns the header, or nothing if this is no ELF file.
    [[nodiscard]] std::optional<GElf_Ehdr> header() const {
        GElf_Ehdr header;
        if (elf_ == nullptr || elf_kind(elf_.get()) != ELF_K_ELF || gelf_getehdr(elf_.get(), &header) == nullptr)
            return {};
        return header;
    }
    [[nodiscard]] std::vector<GElf_Phdr> segments() const {
        std::vector<GElf_Phdr> segments;
        size_t count = 0;
        GElf_Phdr segment;
        if (elf_getphdrnum(elf_.get(), &count) != 0) return {};
        for (size_t i = 0; i < count && gelf_getphdr(elf_.get(), static_cast<int>(i), &segment) != nullptr; ++i)
            segments.push_back(segment);
        return segments;
    }
    // Returns bytes of the file as elements of a type, or null if they are not in the file. Owned by the file.
    Elf_Data* at(uint64_t offset, uint64_t sizeBytes, Elf_Type type) const {
        return elf_getdata_rawchunk(elf_.get(), static_cast<int64_t>(offset), sizeBytes, type);
    }
    // Returns the string at an offset, which ends with the range at the latest.
    [[nodiscard]] std::string string(uint64_t offset, uint64_t mostBytes) const {
        const Elf_Data* data = mostBytes > 0 ? at(offset, mostBytes, ELF_T_BYTE) : nullptr;
        if (data == nullptr) return {};
        const auto* text = static_cast<const char*>(data->d_buf);
        return {text, strnlen(text, data->d_size)};
    }

private:
    struct End {
        void operator()(Elf* elf) const { elf_end(elf); }
    };
    int fd_;
    std::unique_ptr<Elf, End> elf_;
};

void readElf(const File& file, ExecutableFacts& facts) {
    const auto header = file.header();
    if (!header) return;
    facts.kind = FileKind::Elf;
    facts.bits = header->e_ident[EI_CLASS] == ELFCLASS64 ? 64 : 32;
    facts.machine = header->e_machine;
    for (const GElf_Phdr& segment : file.segments()) {
        if (segment.p_type != PT_INTERP) continue;
        facts.hasInterpreter = true;
        facts.interpreter = file.string(segment.p_offset, segment.p_filesz);
    }
}

// Converts an address to a file offset.
std::optional<uint64_t> offsetOf(const std::vector<GElf_Phdr>& segments, uint64_t address) {
    for (const GElf_Phdr& s : segments) {
        if (s.p_type == PT_LOAD && address >= s.p_vaddr && address - s.p_vaddr < s.p_filesz)
            return address - s.p_vaddr + s.p_offset;
    }
    return {};
}

std::vector<GElf_Dyn> dynamicEntries(const File& file, const std::vector<GElf_Phdr>& segments) {
    std::vector<GElf_Dyn> entries;
    for (const GElf_Phdr& segment : segments) {
        if (segment.p_type != PT_DYNAMIC) continue;
        Elf_Data* data = file.at(segment.p_offset, segment.p_filesz, ELF_T_DYN);
        GElf_Dyn entry;
        for (int i = 0; data != nullptr && gelf_getdyn(data, i, &entry) != nullptr && entry.d_tag != DT_NULL; ++i)
            entries.push_back(entry);
    }
    return entries;
}

std::string_view trimmed(std::string_view s) {
    const auto first = s.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return s.substr(first, s.find_last_not_of(" \t") - first + 1);
}

void readScriptLine(std::string_view head, ExecutableFacts& facts) {
    const std::string_view line = trimmed(head.substr(2, head.find('\n') - 2));
    const auto gap = line.find_first_of(" \t");
    facts.kind = FileKind::Script;
    facts.scriptInterpreter = std::string(line.substr(0, gap));
    if (gap != std::string_view::npos) facts.scriptArgument = std::string(trimmed(line.substr(gap)));
}

} // namespace

Result<ExecutableFacts> readExecutable(const std::string& path) {
    const File file(path);
    if (!file.opened()) return Error{path + " cannot be read: " + std::strerror(errno)};
    const std::string text = file.head();

    ExecutableFacts facts;
    if (text.starts_with(ELFMAG)) {
        readElf(file, facts);
    } else if (text.starts_with("#!")) {
        readScriptLine(text, facts);
    } else if (text.substr(0, text.find('\n')).find('\0') == std::string::npos) {
        facts.kind = FileKind::PlainScript; // like shells: a text has no zero byte in its first line
    }
    return facts;
}

Result<LibraryFacts> readLibrary(const std::string& path) {
    const File file(path);
    if (!file.opened()) return Error{path + " cannot be read: " + std::strerror(errno)};
    const auto header = file.header();
    if (!header || header->e_ident[EI_CLASS] != ELFCLASS64)
        return Error{path + " is not a 64-bit library; check the file"};
    const auto segments = file.segments();
    const auto entries = dynamicEntries(file, segments);
    std::optional<uint64_t> strings;
    uint64_t stringBytes = 0;
    for (const GElf_Dyn& e : entries) {
        if (e.d_tag == DT_STRTAB) strings = offsetOf(segments, e.d_un.d_ptr);
        if (e.d_tag == DT_STRSZ) stringBytes = e.d_un.d_val;
    }
    LibraryFacts facts;
    for (const GElf_Dyn& e : entries) {
        if ((e.d_tag != DT_SONAME && e.d_tag != DT_NEEDED) || !strings || e.d_un.d_val >= stringBytes) continue;
        const std::string name = file.string(*strings + e.d_un.d_val, stringBytes - e.d_un.d_val);
        if (e.d_tag == DT_SONAME)
            facts.soname = name;
        else
            facts.needed.push_back(name);
    }
    return facts;
}

int ownBits() { return static_cast<int>(sizeof(void*)) * 8; }

uint16_t ownMachine() {
    const auto own = readExecutable("/proc/self/exe");
    return own.ok() ? own.value().machine : uint16_t{EM_NONE};
}

} // namespace mural::launch
