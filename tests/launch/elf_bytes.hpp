// The smallest files that count as programs, for tests that must not depend on what is installed.
#pragma once

#include <cstring>
#include <elf.h>
#include <string>

namespace mural::test {

inline std::string elf64(bool withInterpreter, uint16_t machine) {
    Elf64_Ehdr header{};
    std::memcpy(header.e_ident, ELFMAG, SELFMAG);
    header.e_ident[EI_CLASS] = ELFCLASS64;
    header.e_ident[EI_DATA] = ELFDATA2LSB;
    header.e_machine = machine;
    header.e_type = ET_DYN;
    header.e_phoff = sizeof header;
    header.e_phentsize = sizeof(Elf64_Phdr);
    header.e_phnum = withInterpreter ? 2 : 1;
    Elf64_Phdr programs[2] = {};
    programs[0].p_type = PT_LOAD;
    programs[1].p_type = PT_INTERP;
    std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
    return bytes.append(reinterpret_cast<const char*>(programs), sizeof(Elf64_Phdr) * header.e_phnum);
}

inline std::string elf32() {
    Elf32_Ehdr header{};
    std::memcpy(header.e_ident, ELFMAG, SELFMAG);
    header.e_ident[EI_CLASS] = ELFCLASS32;
    header.e_machine = EM_386;
    header.e_phentsize = sizeof(Elf32_Phdr);
    return {reinterpret_cast<const char*>(&header), sizeof header};
}

} // namespace mural::test
