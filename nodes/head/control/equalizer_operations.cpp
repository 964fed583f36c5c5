#include "nodes/head/control/equalizer_operations.hpp"

#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;
using Kind = ControlArgument::Kind;

std::string textOf(const Json& scalar) { return scalar.is_string() ? scalar.get<std::string>() : jsonText(scalar); }

} // namespace

void addEqualizerOperations(ControlOperations& operations, EqualizerControl& equalizers) {
    operations.add({"equalizers", "", "list the equalizers with their parameters", {}, [&equalizers](const Json&) {
                        return Result<Json>(Json{{"equalizers", equalizers.list()}});
                    }});
    operations.add({"equalizer-set",
                    "equalizer NAME set PARAMETER VALUE",
                    "set a parameter of an equalizer from its next decision on",
                    {{"name", Kind::Text, true, "name of the equalizer"},
                     {"parameter", Kind::Text, true, "name of the parameter"},
                     {"value", Kind::Scalar, true, "new value"}},
                    [&equalizers](const Json& arguments) -> Result<Json> {
                        const auto set = equalizers.set(textOf(arguments.at("name")), textOf(arguments.at("parameter")),
                                                        textOf(arguments.at("value")));
                        if (!set) return set.error();
                        return Json::object();
                    }});
    operations.add({"equalizer-freeze",
                    "equalizer NAME freeze FROZEN",
                    "keep the current division of the work (on), or release it (off)",
                    {{"name", Kind::Text, true, "name of the equalizer"},
                     {"frozen", Kind::Truth, true, "true: the division stays"}},
                    [&equalizers](const Json& arguments) -> Result<Json> {
                        const auto frozen =
                            equalizers.freeze(textOf(arguments.at("name")), arguments.at("frozen").get<bool>());
                        if (!frozen) return frozen.error();
                        return Json::object();
                    }});
}

} // namespace mural
