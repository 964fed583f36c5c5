#include "nodes/launch/elf_check.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstddef>
#include <cstring>
#include <elf.h>
#include <fcntl.h>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace mural::launch {

namespace {

constexpr size_t kHeadBytes = 512; // the kernel reads 256 bytes of a "#!" line; ELF headers are smaller than this
constexpr size_t kMaxProgramHeaders = 4096;
constexpr uint64_t kMaxPathBytes = 4096;
constexpr uint64_t kMaxTableBytes = 64 << 20; // string tables of the largest libraries have a few MiB

class File {
public:
    explicit File(const std::string& path) : fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() {
        if (fd_ >= 0) close(fd_);
    }
    [[nodiscard]] bool opened() const { return fd_ >= 0; }
    // Returns the number of bytes read, fewer than requested at the end of the file.
    size_t readAt(void* into, size_t sizeBytes, uint64_t at) const {
        size_t done = 0;
        while (done < sizeBytes) {
            const ssize_t n =
                pread(fd_, static_cast<char*>(into) + done, sizeBytes - done, static_cast<off_t>(at + done));
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) break;
            done += static_cast<size_t>(n);
        }
        return done;
    }

private:
    int fd_;
};

template <class Header, class Program> void readElf(const File& file, ExecutableFacts& facts) {
    Header header{};
    if (file.readAt(&header, sizeof header, 0) != sizeof header) return;
    facts.kind = FileKind::Elf;
    facts.machine = header.e_machine;
    if (header.e_phentsize != sizeof(Program) || header.e_phnum > kMaxProgramHeaders) return;
    std::vector<Program> programs(header.e_phnum);
    const size_t wanted = programs.size() * sizeof(Program);
    if (file.readAt(programs.data(), wanted, header.e_phoff) != wanted) return;
    for (const Program& p : programs) {
        if (p.p_type != PT_INTERP) continue;
        facts.hasInterpreter = true;
        std::string name(std::min<uint64_t>(p.p_filesz, kMaxPathBytes), '\0');
        name.resize(file.readAt(name.data(), name.size(), p.p_offset));
        facts.interpreter = name.substr(0, name.find('\0'));
    }
}

template <class T> std::vector<T> readTable(const File& file, uint64_t at, uint64_t sizeBytes) {
    std::vector<T> rows(std::min(sizeBytes, kMaxTableBytes) / sizeof(T));
    rows.resize(file.readAt(rows.data(), rows.size() * sizeof(T), at) / sizeof(T));
    return rows;
}

// Converts an address to a file offset. UINT64_MAX: not in the file.
uint64_t offsetOf(const std::vector<Elf64_Phdr>& programs, uint64_t address) {
    for (const Elf64_Phdr& p : programs) {
        if (p.p_type == PT_LOAD && address >= p.p_vaddr && address - p.p_vaddr < p.p_filesz)
            return address - p.p_vaddr + p.p_offset;
    }
    return UINT64_MAX;
}

// The strings of a dynamic section, by offset into its string table.
class Strings {
public:
    Strings(const File& file, const std::vector<Elf64_Phdr>& programs, const std::vector<Elf64_Dyn>& dynamic) {
        uint64_t at = UINT64_MAX;
        uint64_t sizeBytes = 0;
        for (const Elf64_Dyn& d : dynamic) {
            if (d.d_tag == DT_STRTAB) at = offsetOf(programs, d.d_un.d_ptr);
            if (d.d_tag == DT_STRSZ) sizeBytes = d.d_un.d_val;
        }
        if (at != UINT64_MAX) bytes_ = readTable<char>(file, at, sizeBytes);
    }
    [[nodiscard]] std::string at(uint64_t place) const {
        if (place >= bytes_.size()) return {};
        const auto first = bytes_.begin() + static_cast<std::ptrdiff_t>(place);
        return {first, std::find(first, bytes_.end(), '\0')};
    }

private:
    std::vector<char> bytes_;
};

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
    char head[kHeadBytes];
    const std::string_view text(head, file.readAt(head, sizeof head, 0));

    ExecutableFacts facts;
    if (text.size() > EI_CLASS && text.starts_with(ELFMAG)) {
        if (text[EI_CLASS] == ELFCLASS64) {
            facts.bits = 64;
            readElf<Elf64_Ehdr, Elf64_Phdr>(file, facts);
        } else if (text[EI_CLASS] == ELFCLASS32) {
            facts.bits = 32;
            readElf<Elf32_Ehdr, Elf32_Phdr>(file, facts);
        }
    } else if (text.starts_with("#!")) {
        readScriptLine(text, facts);
    } else if (text.substr(0, text.find('\n')).find('\0') == std::string_view::npos) {
        facts.kind = FileKind::PlainScript; // like shells: a text has no zero byte in its first line
    }
    return facts;
}

Result<LibraryFacts> readLibrary(const std::string& path) {
    const File file(path);
    if (!file.opened()) return Error{path + " cannot be read: " + std::strerror(errno)};
    Elf64_Ehdr header{};
    const bool whole = file.readAt(&header, sizeof header, 0) == sizeof header;
    if (!whole || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS64 ||
        header.e_phentsize != sizeof(Elf64_Phdr)) {
        return Error{path + " is not a 64-bit library; check the file"};
    }
    const auto programs = readTable<Elf64_Phdr>(file, header.e_phoff, uint64_t{header.e_phnum} * sizeof(Elf64_Phdr));
    std::vector<Elf64_Dyn> dynamic;
    for (const Elf64_Phdr& p : programs) {
        if (p.p_type == PT_DYNAMIC) dynamic = readTable<Elf64_Dyn>(file, p.p_offset, p.p_filesz);
    }
    const Strings strings(file, programs, dynamic);
    LibraryFacts facts;
    for (const Elf64_Dyn& d : dynamic) {
        if (d.d_tag == DT_NULL) break;
        if (d.d_tag == DT_SONAME) facts.soname = strings.at(d.d_un.d_val);
        if (d.d_tag == DT_NEEDED) facts.needed.push_back(strings.at(d.d_un.d_val));
    }
    return facts;
}

int ownBits() { return static_cast<int>(sizeof(void*)) * 8; }

uint16_t ownMachine() {
    const auto own = readExecutable("/proc/self/exe");
    return own.ok() ? own.value().machine : uint16_t{EM_NONE};
}

} // namespace mural::launch
