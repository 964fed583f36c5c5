#include "nodes/launch/elf_check.hpp"

#include <cerrno>
#include <cstring>
#include <elf.h>
#include <fcntl.h>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace mural::launch {

namespace {

constexpr size_t kHeadBytes = 512; // the kernel reads 256 for "#!"; ELF headers are smaller
constexpr size_t kMaxProgramHeaders = 4096;

class File {
public:
    explicit File(const std::string& path) : fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() {
        if (fd_ >= 0) close(fd_);
    }
    [[nodiscard]] bool opened() const { return fd_ >= 0; }
    // Bytes read, less than asked at the end of the file.
    size_t readAt(void* into, size_t sizeBytes, uint64_t at) const {
        size_t done = 0;
        while (done < sizeBytes) {
            const ssize_t n = pread(fd_, static_cast<char*>(into) + done, sizeBytes - done,
                                    static_cast<off_t>(at + done));
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
        if (p.p_type == PT_INTERP) facts.hasInterpreter = true;
    }
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
        facts.kind = FileKind::PlainScript; // the test that shells use: no zero byte in the first line
    }
    return facts;
}

int ownBits() { return static_cast<int>(sizeof(void*)) * 8; }

uint16_t ownMachine() {
    const auto own = readExecutable("/proc/self/exe");
    return own.ok() ? own.value().machine : uint16_t{EM_NONE};
}

} // namespace mural::launch
