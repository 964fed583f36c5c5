// Makes random OpenGL calls: each seed has a new context. After each step the transcript records the errors and a
// digest of the GL's output. run_random_gl.py compares the transcripts of two runs.
//
//   random_gl --profile compat|core|es1|es3 --out FILE [--extensions FILE] [--trace] --seeds 1:40 --steps 200
//   random_gl … --cases FILE       each line is a seed and its steps, for example "12 3,17,25"
//   random_gl … --print-extensions
#include "tests/programs/support/gl.hpp"

#include <GL/glx.h>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numeric>
#include <sstream>
#include <vector>

#include "tests/fuzz/random_gl/recipes.hpp"
#include "tests/programs/support/program.hpp"

namespace fuzz {
namespace {

struct Settings {
    Profile profile = Profile::Compat;
    std::string seeds = "1";
    std::uint64_t steps = 200;
    std::string cases; // file name
    std::string out = "/dev/stdout";
    std::string extensions; // file name; empty: the extensions of the context
    bool trace = false;
    bool printExtensions = false;
};

Profile profileOf(const std::string& name) {
    for (const auto& [word, profile] : {std::pair{"compat", Profile::Compat},
                                        {"core", Profile::Core},
                                        {"es1", Profile::Es1},
                                        {"es3", Profile::Es3}}) {
        if (name == word) {
            return profile;
        }
    }
    programs::fail("no profile \"%s\": compat, core, es1, es3", name.c_str());
}

Settings parse(int argc, char** argv) {
    Settings s;
    for (int i = 1; i < argc; ++i) {
        const std::string option = argv[i];
        if (option == "--trace") {
            s.trace = true;
            continue;
        }
        if (option == "--print-extensions") {
            s.printExtensions = true;
            continue;
        }
        if (++i == argc) {
            programs::fail("%s: no such option, or its value is missing", option.c_str());
        }
        const std::string value = argv[i];
        if (option == "--profile") {
            s.profile = profileOf(value);
        } else if (option == "--seeds") {
            s.seeds = value;
        } else if (option == "--steps") {
            s.steps = std::strtoull(value.c_str(), nullptr, 10);
        } else if (option == "--out") {
            s.out = value;
        } else if (option == "--extensions") {
            s.extensions = value;
        } else if (option == "--cases") {
            s.cases = value;
        } else {
            programs::fail("%s: no such option", option.c_str());
        }
    }
    return s;
}

programs::WindowSpec windowOf(Profile profile) {
    programs::WindowSpec spec;
    spec.alpha = 8;
    spec.accum = 16;
    switch (profile) {
    case Profile::Compat: break;
    case Profile::Core: spec.profile = programs::Profile::Core, spec.major = 4, spec.minor = 5; break;
    case Profile::Es1: spec.profile = programs::Profile::Es, spec.major = 1, spec.minor = 1; break;
    case Profile::Es3: spec.profile = programs::Profile::Es, spec.major = 3, spec.minor = 2; break;
    }
    return spec;
}

std::string contextExtensions(Profile profile) {
    std::string all = " ";
    if (profile == Profile::Compat || profile == Profile::Es1) {
        return all + reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS)) + " ";
    }
    GLint count = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; ++i) {
        all += reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
        all += " ";
    }
    return all;
}

std::string readFile(const std::string& path) {
    std::ifstream file(path);
    if (!file) {
        programs::fail("cannot read %s", path.c_str());
    }
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

struct Case {
    std::uint64_t id, seed;
    std::vector<std::uint64_t> steps;
};

std::vector<Case> casesOf(const Settings& s) {
    std::vector<Case> cases;
    if (!s.cases.empty()) {
        std::istringstream lines(readFile(s.cases));
        std::uint64_t seed = 0;
        for (std::string list; lines >> seed >> list;) {
            Case one{cases.size(), seed, {}};
            std::istringstream words(list);
            for (std::string word; std::getline(words, word, ',');) {
                one.steps.push_back(std::strtoull(word.c_str(), nullptr, 10));
            }
            cases.push_back(one);
        }
        return cases;
    }
    const std::size_t colon = s.seeds.find(':');
    const std::uint64_t first = std::strtoull(s.seeds.c_str(), nullptr, 10);
    const std::uint64_t last =
        colon == std::string::npos ? first : std::strtoull(s.seeds.c_str() + colon + 1, nullptr, 10);
    std::vector<std::uint64_t> steps(s.steps);
    std::iota(steps.begin(), steps.end(), 0);
    for (std::uint64_t seed = first; seed <= last; ++seed) {
        cases.push_back({seed, seed, steps});
    }
    return cases;
}

class Kitchen { // all recipes of a profile, and single calls
public:
    explicit Kitchen(Profile profile) {
        const char letter = profile == Profile::Compat ? 'c'
                            : profile == Profile::Core ? 'k'
                            : profile == Profile::Es1  ? '1'
                                                       : '3';
        for (const auto& recipes : {drawRecipes(), fixedRecipes(), imageRecipes(), objectRecipes(), programRecipes()}) {
            for (const Recipe& recipe : recipes) {
                if (std::strchr(recipe.profiles, letter) != nullptr) {
                    book_.insert(book_.end(), static_cast<std::size_t>(recipe.weight), &recipe);
                }
            }
        }
    }

    const char* step(World& w) {
        const char* name = "a call";
        if (w.random.chance(50)) {
            callAny(w);
        } else {
            const Recipe& recipe = *book_[w.random.below(static_cast<std::uint32_t>(book_.size()))];
            recipe.cook(w);
            name = recipe.name;
        }
        barrier(w);
        return name;
    }

private:
    std::vector<const Recipe*> book_;
};

class Transcript {
public:
    explicit Transcript(const std::string& path) : file_(std::fopen(path.c_str(), "w")) {
        if (file_ == nullptr) {
            programs::fail("cannot write %s", path.c_str());
        }
    }
    Transcript(const Transcript&) = delete;
    Transcript& operator=(const Transcript&) = delete;
    ~Transcript() { std::fclose(file_); }

    // Writes one line, flushed so that it survives when the next call ends the process.
    void write(std::uint64_t id, const char* step, const char* what, World& w) {
        (void)w.failed();
        std::string errors;
        for (const GLenum error : w.errors) {
            errors += " " + shown(error);
        }
        w.errors.clear();
        char digestText[20];
        std::snprintf(digestText, sizeof digestText, "%016llx", static_cast<unsigned long long>(w.takeSeen()));
        std::fprintf(file_, "%llu %s %s%s; %s\n", static_cast<unsigned long long>(id), step, digestText, errors.c_str(),
                     what);
        std::fflush(file_);
        if (w.trace) {
            std::fprintf(stderr, "%s %s: %s%s\n", step, what, digestText, errors.c_str());
        }
    }

private:
    std::FILE* file_;
};

void runCase(const Case& one, const Settings& s, Kitchen& kitchen, Transcript& transcript,
             const std::string& extensions) {
    const auto window = programs::openGlxWindow(windowOf(s.profile), kWidth, kHeight);
    window->makeCurrent();
    World w(s.profile, extensions.empty() ? contextExtensions(s.profile) : extensions, s.trace);
    constexpr std::uint64_t kBegin = ~std::uint64_t{0};
    w.random = Random(one.seed, kBegin);
    w.attributeSize = static_cast<int>(one.seed % 4) + 1;
    begin(w);
    transcript.write(one.id, "begin", "", w);
    for (const std::uint64_t step : one.steps) {
        w.random = Random(one.seed, step);
        transcript.write(one.id, std::to_string(step).c_str(), kitchen.step(w), w);
    }
    w.random = Random(one.seed, kBegin - 1);
    dumpState(w);
    transcript.write(one.id, "state", "", w);
    calm(w);
    observeTargets(w);
    transcript.write(one.id, "picture", "", w);
    window->swap();
}

} // namespace
} // namespace fuzz

int main(int argc, char** argv) {
    using namespace fuzz;
    const Settings s = parse(argc, argv);
    if (s.printExtensions) {
        const auto window = programs::openGlxWindow(windowOf(s.profile), kWidth, kHeight);
        window->makeCurrent();
        std::ofstream(s.out) << contextExtensions(s.profile);
        window->release();
        return 0;
    }
    const std::string extensions = s.extensions.empty() ? std::string() : readFile(s.extensions);
    Kitchen kitchen(s.profile);
    Transcript transcript(s.out);
    for (const Case& one : casesOf(s)) {
        runCase(one, s, kitchen, transcript, extensions);
    }
    return 0;
}
