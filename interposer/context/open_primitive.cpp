#include "interposer/context/open_primitive.hpp"

namespace mural {

bool primitiveIsOpen(Context& c) {
    if (!answersNothing()) c.openPrimitive = kNoPrimitive;
    return c.openPrimitive != kNoPrimitive;
}

} // namespace mural
