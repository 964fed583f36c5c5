// Minimal files that count as programs, for tests independent of installed software.
#pragma once

#include <cstring>
#include <elf.h>
#include <string>
#include <vector>

namespace mural::test {

inline std::string elf64(bool withInterpreter, uint16_t machine) {
    Elf64_Ehdr header{};
    std::memcpy(header.e_ident, ELFMAG, SELFMAG);
    header.e_ident[EI_CLASS] = ELFCLASS64;
    header.e_ident[EI_DATA] = ELFDATA2LSB;
    header.e_ident[EI_VERSION] = EV_CURRENT;
    header.e_version = EV_CURRENT;
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
    header.e_ident[EI_DATA] = ELFDATA2LSB;
    header.e_ident[EI_VERSION] = EV_CURRENT;
    header.e_version = EV_CURRENT;
    header.e_machine = EM_386;
    header.e_phentsize = sizeof(Elf32_Phdr);
    return {reinterpret_cast<const char*>(&header), sizeof header};
}

// A shared library with only a name and dependencies.
inline std::string library64(const std::string& soname, const std::vector<std::string>& needed) {
    std::string strings(1, '\0');
    std::vector<Elf64_Dyn> dynamic;
    const auto add = [&](Elf64_Sxword tag, const std::string& text) {
        dynamic.push_back({tag, {strings.size()}});
        strings += text + '\0';
    };
    for (const std::string& name : needed) add(DT_NEEDED, name);
    add(DT_SONAME, soname);
    Elf64_Ehdr header{};
    std::memcpy(header.e_ident, ELFMAG, SELFMAG);
    header.e_ident[EI_CLASS] = ELFCLASS64;
    header.e_ident[EI_DATA] = ELFDATA2LSB;
    header.e_ident[EI_VERSION] = EV_CURRENT;
    header.e_version = EV_CURRENT;
    header.e_type = ET_DYN;
    header.e_phoff = sizeof header;
    header.e_phentsize = sizeof(Elf64_Phdr);
    header.e_phnum = 2;
    const uint64_t dynamicAt = sizeof header + 2 * sizeof(Elf64_Phdr);
    const uint64_t stringsAt = dynamicAt + (dynamic.size() + 3) * sizeof(Elf64_Dyn);
    constexpr uint64_t kBase = 0x10000; // addresses differ from file offsets
    dynamic.push_back({DT_STRTAB, {kBase + stringsAt}});
    dynamic.push_back({DT_STRSZ, {strings.size()}});
    dynamic.push_back({DT_NULL, {0}});
    Elf64_Phdr programs[2] = {};
    programs[0].p_type = PT_LOAD;
    programs[0].p_vaddr = kBase;
    programs[0].p_filesz = stringsAt + strings.size();
    programs[1].p_type = PT_DYNAMIC;
    programs[1].p_offset = dynamicAt;
    programs[1].p_filesz = dynamic.size() * sizeof(Elf64_Dyn);
    std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
    bytes.append(reinterpret_cast<const char*>(programs), sizeof programs);
    bytes.append(reinterpret_cast<const char*>(dynamic.data()), dynamic.size() * sizeof(Elf64_Dyn));
    return bytes + strings;
}

} // namespace mural::test
