/* vox_mpi: the transport of vox_dist.h over MPI, built for the MPI whose mpi.h it was compiled with. Conventions:
 * as in vox_dist.h.
 *   Threads    As MPI_Init_thread allows. */
#ifndef VOX_VOX_MPI_H
#define VOX_VOX_MPI_H

#include <mpi.h>
#include <vox/vox_dist.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Collective over `comm`. Makes a transport over a duplicate of it, for any number of scenes, one at a time. Set
 * out_transport->struct_size first. Release it with vox_mpi_transport_destroy after the scenes and before
 * MPI_Finalize. Errors: INVALID_ARGUMENT (a null communicator, or one between two groups), INVALID_STATE (MPI is not
 * running), OUT_OF_MEMORY, INTERNAL (with the text of MPI). */
VOX_EXPERIMENTAL vox_result vox_mpi_transport_create(MPI_Comm comm, vox_dist_transport* out_transport);

/* Collective. Ends a transport. Null, or one that was not created or has ended, does nothing. */
VOX_EXPERIMENTAL void vox_mpi_transport_destroy(VOX_OPTIONAL vox_dist_transport* transport);

#ifdef __cplusplus
}
#endif

#endif
