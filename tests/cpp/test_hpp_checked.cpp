#define VOX_HPP_CHECKED 1
#include "cpp/hpp_cases.hpp"

SUITE(hpp_checked) { add_hpp_cases(suite); }
