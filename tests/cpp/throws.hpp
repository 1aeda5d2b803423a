// What the tests of the C++ headers that throw share.
#ifndef VOX_TESTS_CPP_THROWS_HPP
#define VOX_TESTS_CPP_THROWS_HPP

#include <vox/vox.hpp>

#include <cstring>

#include "support/suite.h" // last: it defines macros with common names

// The call throws vox::error with this result, and these words in its text, which is that of
// vox_last_error().
template <class F>
void throws(F&& call, vox_result result, const char* words) {
    try {
        call();
    } catch (const vox::error& error) {
        ck_assert_msg(error.result() == result, "%s: %s", vox_result_string(error.result()), error.what());
        ck_assert_msg(std::strstr(error.what(), words) != nullptr, "the text is \"%s\", expected \"%s\"",
                      error.what(), words);
        ck_assert_str_eq(error.what(), vox_last_error());
        return;
    }
    ck_abort_msg("nothing was thrown, expected %s", vox_result_string(result));
}

#endif
