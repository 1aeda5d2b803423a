// vox_io over a C++ heap that fails: every allocation in turn while files are read, reported on, filled and
// written. The readers of assimp are not ours, and are left out.
#include "support/failing_heap.hpp"

#include <vox/vox_io.h>

#include <cstdio>
#include <string>

namespace {

struct Held {
    vox_io_mesh* mesh = nullptr;
    vox_io_mesh* filled = nullptr;
    ~Held() {
        vox_io_mesh_destroy(mesh);
        vox_io_mesh_destroy(filled);
    }
};

std::int32_t add_up(const void* data, std::size_t size, void* user) {
    std::uint64_t& sum = *static_cast<std::uint64_t*>(user);
    for (std::size_t i = 0; i < size; ++i) sum = sum * 31 + static_cast<const unsigned char*>(data)[i];
    return 0;
}

// Writes a mesh in this format; the sum of its bytes goes to *sum.
bool write_to(const vox_io_mesh* mesh, vox_io_write_format format, std::uint32_t binary, heap::Life& life,
              std::uint64_t* sum) {
    vox_io_write_desc desc = vox_default_io_write_desc();
    desc.format = format;
    desc.binary = binary;
    return life([&] {
        *sum = 0;
        const vox_io_sink sink = {add_up, sum};
        return vox_io_write_to(mesh, &desc, &sink);
    });
}

START_TEST(each_allocation_of_a_load) {
    const char* const names[] = {"box.node",
                                 "box.mesh",
                                 "box.veg",
                                 "box_1.msh",
                                 "box_22_little.msh",
                                 "box_41_big.msh",
                                 "box_30.vtk",
                                 "box_51_binary.vtk",
                                 "box_ascii.vtu",
                                 "box_appended.vtu",
                                 "box_base64_zlib.vtu",
                                 "cube.off",
                                 "cube.stl",
                                 "cube.obj",
                                 "cube.ply",
                                 "two_tetrahedra.gltf",
                                 "two_tetrahedra.glb"};
    for (const char* name : names) {
        const std::string path = std::string(VOX_TEST_DATA "/") + name;
        heap::fail_each([&](heap::Life& life) {
            Held held;
            vox_io_report report;
            report.struct_size = sizeof report;
            if (life([&] { return vox_io_load(path.c_str(), nullptr, &held.mesh); }) &&
                life([&] { return vox_io_mesh_get_report(held.mesh, &report); }))
                life.hash = report.vertices * 1000 + report.tets;
        });
    }
}
END_TEST

START_TEST(each_allocation_of_bodies_and_writers) {
    heap::fail_each([](heap::Life& life) {
        Held held;
        std::uint64_t sums[3] = {0, 0, 0};
        if (life([&] { return vox_io_make_ball(1, 0.7, &held.mesh); }) &&
            write_to(held.mesh, VOX_IO_WRITE_MSH_22, 0, life, &sums[0]) &&
            write_to(held.mesh, VOX_IO_WRITE_MSH_41, 1, life, &sums[1]) &&
            write_to(held.mesh, VOX_IO_WRITE_VTU, 1, life, &sums[2]))
            life.hash = sums[0] ^ sums[1] ^ sums[2];
    });
}
END_TEST

// Of a file that is not finished nothing stays.
START_TEST(each_allocation_of_a_written_file) {
    const std::string path = "vox_test_io_heap_file.vtu", part = path + ".part";
    heap::fail_each([&](heap::Life& life) {
        Held held;
        (void)(life([&] { return vox_io_make_ball(1, 0.7, &held.mesh); }) &&
               life([&] { return vox_io_write(held.mesh, path.c_str(), nullptr); }));
        ck_assert_int_ne(std::remove(part.c_str()), 0);
    });
    std::remove(path.c_str());
}
END_TEST

START_TEST(each_allocation_of_a_fill) {
    vox_io_mesh* surface = nullptr;
    ck_ok(vox_io_load(VOX_TEST_DATA "/cube.off", nullptr, &surface));
    vox_io_tetrahedralize_desc desc = vox_default_io_tetrahedralize_desc();
    desc.cell = 0.5;
    heap::fail_each(
        [&](heap::Life& life) {
            Held held;
            vox_io_mesh_view view;
            if (!life([&] { return vox_io_tetrahedralize(surface, &desc, &held.filled); })) return;
            ck_ok(vox_io_mesh_get_arrays(held.filled, &view));
            life.hash = view.tet_count;
        },
        3);
    vox_io_mesh_destroy(surface);
}
END_TEST

void* allocate(std::size_t size, std::size_t, void*) { return std::malloc(size); }
void release(void* memory, std::size_t, std::size_t, void*) { std::free(memory); }

// A mesh in the memory of the caller leaves nothing of its arrays, or of the reader's notes, on the C++ heap.
START_TEST(nothing_besides_memory_of_the_caller) {
    vox_io_load_desc desc = vox_default_io_load_desc();
    const vox_allocator allocator{allocate, release, nullptr};
    desc.allocator = &allocator;
    for (const char* name : {"box.mesh", "box.veg", "cube.off"}) {
        const std::string path = std::string(VOX_TEST_DATA "/") + name;
        vox_io_mesh* mesh = nullptr;
        ck_ok(vox_io_load(path.c_str(), &desc, &mesh)); // what is made once a process
        vox_io_mesh_destroy(mesh);
        const std::int64_t before = heap::held;
        ck_ok(vox_io_load(path.c_str(), &desc, &mesh));
        const bool has_warnings = *vox_io_mesh_get_warnings(mesh) != '\0';
        ck_assert_msg(heap::held <= before + has_warnings, "%s: %d blocks of the C++ heap", name,
                      int(heap::held - before));
        vox_io_mesh_destroy(mesh);
    }
}
END_TEST

} // namespace

SUITE(io_heap) {
    TCase* tests = add_case(suite, "heap");
    tcase_add_each(tests, each_allocation_of_a_load, each_allocation_of_bodies_and_writers,
                   each_allocation_of_a_written_file, each_allocation_of_a_fill,
                   nothing_besides_memory_of_the_caller);
}
