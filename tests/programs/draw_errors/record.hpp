// Shows errors as pictures: the errors of a list of calls become one number, shown as bits.
#pragma once

#include <cstdint>

namespace programs {

// Folds all errors that glGetError reports now into `sum`. GetError comes from the library that the program links.
template <class GetError> std::uint32_t foldErrors(std::uint32_t sum, GetError getError) {
    sum = sum * 31 + 1; // includes the position in the list
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
