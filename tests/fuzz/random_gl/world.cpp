#include "tests/fuzz/random_gl/world.hpp"

namespace fuzz {

World::World(Profile wantedProfile, std::string extensions, bool wantTrace)
    : profile(wantedProfile), trace(wantTrace), extensions_(std::move(extensions)), families_(kFamilies) {
    for (const Command& command : kCommands) {
        if (offers(command)) {
            families_[command.family].push_back(&command);
        }
    }
    std::erase_if(families_, [](const auto& family) { return family.empty(); });
}

bool World::has(std::string_view extension) const {
    return extensions_.find(" " + std::string(extension) + " ") != std::string::npos;
}

bool World::offers(const Command& command) const {
    if (profile == Profile::Es1 ? command.es1 != 0
        : es()                  ? command.es2 != 0 && command.es2 <= 32
                                : command.gl != 0 && command.gl <= 45) {
        return true;
    }
    for (std::string_view rest = command.extensions; !rest.empty();) {
        const std::size_t end = rest.find(' ');
        const std::string_view word = rest.substr(0, end);
        if (!word.empty() && has(word)) {
            return true;
        }
        rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    }
    return false;
}

GLuint World::living(Kind kind) {
    const auto& names = names_[static_cast<std::size_t>(kind)];
    const std::uint32_t first = random.below(kSlots);
    for (std::uint32_t i = 0; i < kSlots; ++i) {
        if (names[(first + i) % kSlots] != 0) {
            return names[(first + i) % kSlots];
        }
    }
    return 0;
}

GLuint World::name(Kind kind) {
    const std::uint32_t dice = random.below(100);
    if (dice < 8) {
        return 0;
    }
    // Outside the core profile, binding an unused name creates it.
    return dice < 11 ? random.below(12) : living(kind);
}

void World::keep(Kind kind, GLuint name) {
    if (name != 0) {
        slot(kind, random.below(kSlots)) = name;
    }
}

std::uint64_t World::takeSeen() {
    const std::uint64_t seen = seen_;
    seen_ = 0;
    return seen;
}

bool World::failed() {
    const std::size_t before = errors.size();
    for (GLenum error = glGetError(); error != GL_NO_ERROR && errors.size() < before + 8; error = glGetError()) {
        errors.push_back(error);
    }
    return errors.size() > before;
}

void World::traceError() {
    if (trace && !insideBegin && failed()) {
        std::fprintf(stderr, "        error %s\n", shown(errors.back()).c_str());
    }
}

void traceText(const char* name, const std::string& arguments) {
    std::fprintf(stderr, "    %s( %s)\n", name, arguments.c_str());
}

} // namespace fuzz
