/* Version: of the header this program was compiled with, and of the library it runs with. */
#include "example.h"

int main(void) {
    const uint32_t compiled = VOX_VERSION_MAJOR * 1000000u + VOX_VERSION_MINOR * 1000u + VOX_VERSION_PATCH;
    printf("compiled with %u, runs with %u\n", (unsigned)compiled, (unsigned)vox_version());
    printf("%s\n", vox_build_info());
    return vox_version() / 1000000u == VOX_VERSION_MAJOR ? 0 : 1; /* the same major version: it fits */
}
