// Feeds arbitrary text to the reader of configuration files. It reports an error or returns a configuration. The
// configuration can be written and read again unchanged, resolved, checked, and planned.
#include <string_view>

#include "balancer/compound/check_config.hpp"
#include "balancer/config/resolve.hpp"
#include "balancer/config/eqc/parser.hpp"
#include "balancer/config/eqc/writer.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace mural::fuzz {

uint64_t fuzzOne(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    config::Diagnostics diagnostics("input");
    const config::ConfigFile file = config::parseConfig(text, diagnostics);
    if (diagnostics.errors() > 0) {
        must(!diagnostics.firstError().empty(), "an error has a line");
        return 0;
    }
    const std::string written = config::writeConfig(file);
    config::Diagnostics again("written");
    must(config::parseConfig(written, again) == file, "what is written reads back");
    must(again.all().empty() || file.version > config::kCurrentVersion, "what is written needs no remark");
    const config::ResolvedConfig resolved = config::resolve(file, {}, diagnostics);
    if (diagnostics.errors() == 0) compound::checkConfig(resolved, diagnostics);
    return 1 + resolved.compounds.size();
}

} // namespace mural::fuzz
