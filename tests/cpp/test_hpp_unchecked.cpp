#define VOX_HPP_CHECKED 0
#include "cpp/hpp_cases.hpp"

SUITE(hpp_unchecked) { add_hpp_cases(suite); }
