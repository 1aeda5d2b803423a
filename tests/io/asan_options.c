/* A sanitizer's allocator refuses what no reader has a reason to ask for. */
const char* __asan_default_options(void);
const char* __asan_default_options(void) { return "max_allocation_size_mb=256:allocator_may_return_null=1"; }
