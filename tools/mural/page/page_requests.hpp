// Requests of `mural page link`, `links`, `revoke` and `--off` to the running page of a session.
#pragma once

#include "tools/mural/page/page_options.hpp"

namespace mural::page {

// Returns the exit status.
int requestOfPage(const PageArguments& arguments);

} // namespace mural::page
