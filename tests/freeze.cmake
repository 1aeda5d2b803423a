# Snapshots.
vox_test(snapshot test_snapshot.c LIBS vox::vox m)
set_tests_properties(snapshot PROPERTIES LABELS valgrind)
target_compile_definitions(test_snapshot PRIVATE _POSIX_C_SOURCE=200809L)
target_compile_options(test_snapshot PRIVATE -Wno-conversion -Wno-float-conversion)
