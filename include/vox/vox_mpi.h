/* vox_mpi: the transport of vox_dist.h over MPI. A library is built for one MPI, that of the mpi.h it was compiled with. */
#ifndef VOX_VOX_MPI_H
#define VOX_VOX_MPI_H

#include <mpi.h>
#include <vox/vox_dist.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Collective over `comm`. A transport between its ranks, over a duplicate of it, so that its messages meet no others. It
 * may be used by any number of scenes, one at a time, from threads as MPI_Init_thread allows. Release it with
 * vox_mpi_transport_destroy before MPI_Finalize, after the scenes. Errors: INVALID_ARGUMENT (a null communicator, or one
 * between two groups), INVALID_STATE (MPI is not running), OUT_OF_MEMORY, INTERNAL (with the text of MPI). */
VOX_EXPERIMENTAL vox_result vox_mpi_transport_create(MPI_Comm comm, vox_transport* out_transport);

/* Collective. Ends a transport. One without `user` is left alone, as is null. */
VOX_EXPERIMENTAL void vox_mpi_transport_destroy(VOX_OPTIONAL vox_transport* transport);

#ifdef __cplusplus
}
#endif

#endif
