// `mural page`: the wall in a browser.
#pragma once

#include "tools/mural/page/page_options.hpp"

namespace CLI {
class App;
}

namespace mural::page {

inline constexpr const char* kPageFooter =
    "Examples:\n  mural page                                the only session; prints an address for a browser\n  mural "
    "page 4711 --at 127.0.0.1:9000       the session of mural run 4711\n  mural page --at 0.0.0.0                   on "
    "all networks, with TLS and a certificate of its own\n  mural page --at unix:/run/user/1000/page  for a reverse "
    "proxy\n  mural page link --role view --for 8h --most 20 --name class\n  mural page links\n  mural page revoke 3   "
    "                    its pages close within a second\n  mural page --off\n\nThe page of another machine is reached "
    "through ssh: ssh -L 8787:127.0.0.1:8787 HOST. docs/reference/page.md\ndescribes roles, limits and the "
    "interface.\nExit status: 0; 1 if no session replies or the request fails; 2 for a bad argument, a port in use, or "
    "missing TLS.";

void describePage(CLI::App& command, PageArguments& arguments);
int pageCommand(const PageArguments& arguments);

} // namespace mural::page
