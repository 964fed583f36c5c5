// Errors as pictures: the errors of a list of calls become one number, shown as bits.
#pragma once

#include <cstdint>

namespace programs {

// All errors that glGetError tells now, folded into `sum`. GetError: of the library the program links.
template <class GetError> std::uint32_t foldErrors(std::uint32_t sum, GetError getError) {
    sum = sum * 31 + 1; // so that the place in the list counts
    for (int i = 0; i < 8; ++i) {
        const unsigned error = getError();
        if (error == 0) {
            break;
        }
        sum = sum * 31 + error;
    }
    return sum;
}

} // namespace programs
