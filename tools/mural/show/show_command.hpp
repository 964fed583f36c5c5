// `mural show`: a wall at another place than the session whose pictures it shows.
#pragma once

#include "tools/mural/show/show_options.hpp"

namespace mural::cli {

int showCommand(const ShowArguments& arguments);

} // namespace mural::cli
