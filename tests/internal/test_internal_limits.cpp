// Limits that would take more memory than a machine has: what checks them, given the counts alone.
#include "base/array.hpp"
#include "base/error.hpp"
#include "grid/mesh_table.hpp"
#include "grid/pairs.hpp"
#include "mesh/topology.hpp"

#include "support/suite.h"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <string>

using namespace vox;

namespace {

// What function() throws, as a code, and its text.
template <class Function>
vox_result thrown_by(Function&& function, std::string& text) {
    try {
        function();
    } catch (const Error& error) {
        text = error.what();
        return error.result();
    }
    return VOX_OK;
}

bool contains(const std::string& text, const char* words) { return text.find(words) != std::string::npos; }

} // namespace

START_TEST(counts_of_a_grid) {
    std::string text;
    const auto check = [&](std::uint64_t count, std::uint64_t added) {
        return thrown_by([&] { check_limit(count, added, VOX_MAX_TETS, "tets"); }, text);
    };
    ck_assert_int_eq(check(0, VOX_MAX_TETS), VOX_OK);
    ck_assert_int_eq(check(VOX_MAX_TETS, 0), VOX_OK);
    ck_assert_int_eq(check(VOX_MAX_TETS - 5, 5), VOX_OK);
    ck_assert_int_eq(check(VOX_MAX_TETS - 5, 6), VOX_ERROR_LIMIT);
    ck_assert(contains(text, "holds 2147483642 tets and cannot take 6 more, the limit is 2147483647"));
    ck_assert_int_eq(check(VOX_MAX_TETS, UINT64_MAX), VOX_ERROR_LIMIT);
}
END_TEST

// None of the elements is looked at.
START_TEST(contacts_of_a_step) {
    std::pmr::memory_resource* memory = std::pmr::new_delete_resource();
    TouchingBuffers buffers(memory);
    vox::Array<vox_pair> pairs(memory);
    vox::Array<std::uint32_t> by_pair(memory);
    const vox_contact contact{};
    std::string text;
    const std::span<const vox_contact> many(&contact, std::size_t{VOX_MAX_CONTACTS} + 1);
    const vox_result result = thrown_by([&] { find_touching(many, 1, buffers, pairs, by_pair); }, text);
    ck_assert_int_eq(result, VOX_ERROR_LIMIT);
    ck_assert(contains(text, "4294967296 contacts, the limit is 4294967295"));
}
END_TEST

// Stages ask this of what they have found.
START_TEST(other_contacts_of_a_step) {
    std::string text;
    for (const char* const what : {"edges", "proximities", "impacts", "constraints"}) {
        check_contact_count(VOX_MAX_CONTACTS, what);
        const vox_result result =
            thrown_by([&] { check_contact_count(std::size_t{VOX_MAX_CONTACTS} + 1, what); }, text);
        ck_assert_int_eq(result, VOX_ERROR_LIMIT);
        ck_assert(contains(text, ("4294967296 " + std::string(what) + ", the limit is 4294967295").c_str()));
    }
}
END_TEST

START_TEST(tets_with_a_surface) {
    Topology topology(std::pmr::new_delete_resource());
    const Tet tet{};
    std::string text;
    const std::span<const Tet> many(&tet, 357913942);
    const vox_result result = thrown_by([&] { make_topology(many, 1, topology); }, text);
    ck_assert_int_eq(result, VOX_ERROR_LIMIT);
    ck_assert(contains(text, "357913942 tets"));
    ck_assert(contains(text, "at most 357913941"));
}
END_TEST

SUITE(internal_limits) {
    TCase* tests = add_case(suite, "limits");
    tcase_add_test(tests, counts_of_a_grid);
    if (sizeof(std::size_t) > 4) { // else no array is as long
        tcase_add_each(tests, contacts_of_a_step, other_contacts_of_a_step, tets_with_a_surface);
    }
}
