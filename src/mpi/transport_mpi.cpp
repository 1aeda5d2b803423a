// The one file that includes mpi.h.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <vox/vox_mpi.h>

#include "base/border.hpp"
#include "base/structs.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

namespace vox::mpi {
namespace {

constexpr int tag = 21;
// An exchange sends longer messages in parts, the last one shorter.
constexpr std::uint64_t longest = 1u << 30;

void check(int error, const char* function) {
    if (error == MPI_SUCCESS) return;
    char text[MPI_MAX_ERROR_STRING] = "";
    int length = 0;
    (void)MPI_Error_string(error, text, &length);
    throw Error(VOX_ERROR_INTERNAL, format("%s: %s", function, text));
}

// The operands of agree: eight minima, then eight sums.
struct Numbers {
    std::uint64_t of[16];
};

void combine(void* in, void* in_out, int* length, MPI_Datatype*) {
    const auto* from = static_cast<const Numbers*>(in);
    auto* to = static_cast<Numbers*>(in_out);
    for (int n = 0; n < *length; ++n)
        for (int i = 0; i < 16; ++i)
            to[n].of[i] = i < 8 ? std::min(to[n].of[i], from[n].of[i]) : to[n].of[i] + from[n].of[i];
}

struct Duplicate {
    MPI_Comm comm = MPI_COMM_NULL;
    MPI_Datatype numbers = MPI_DATATYPE_NULL;
    MPI_Op combination = MPI_OP_NULL;
    std::vector<MPI_Request> requests;
    std::vector<std::vector<std::byte>> received;

    explicit Duplicate(MPI_Comm of) {
        check(MPI_Comm_dup(of, &comm), "MPI_Comm_dup");
        check(MPI_Comm_set_errhandler(comm, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
        check(MPI_Type_contiguous(16, MPI_UINT64_T, &numbers), "MPI_Type_contiguous");
        check(MPI_Type_commit(&numbers), "MPI_Type_commit");
        check(MPI_Op_create(combine, 1, &combination), "MPI_Op_create");
    }
    Duplicate(const Duplicate&) = delete;
    Duplicate& operator=(const Duplicate&) = delete;
    ~Duplicate() {
        if (combination != MPI_OP_NULL) (void)MPI_Op_free(&combination);
        if (numbers != MPI_DATATYPE_NULL) (void)MPI_Type_free(&numbers);
        if (comm != MPI_COMM_NULL) (void)MPI_Comm_free(&comm);
    }
};

vox_result allgather(const void* in, std::uint64_t bytes, void* out, void* user) {
    return border([&] {
        const auto count = static_cast<int>(bytes);
        check(MPI_Allgather(in, count, MPI_BYTE, out, count, MPI_BYTE, static_cast<Duplicate*>(user)->comm),
              "MPI_Allgather");
    });
}

// Receives one message. Returns false if there is no memory; the message is then taken from MPI and lost.
bool receive(Duplicate& mpi, std::uint32_t rank, std::vector<std::byte>& bytes) {
    bytes.clear();
    bool memory = true;
    for (int count = static_cast<int>(longest); count == static_cast<int>(longest);) {
        MPI_Message message;
        MPI_Status status;
        check(MPI_Mprobe(static_cast<int>(rank), tag, mpi.comm, &message, &status), "MPI_Mprobe");
        check(MPI_Get_count(&status, MPI_BYTE, &count), "MPI_Get_count");
        const std::size_t at = bytes.size();
        try {
            if (memory) bytes.resize(at + static_cast<std::size_t>(count));
        } catch (const std::bad_alloc&) {
            memory = false;
        }
        if (memory) {
            check(MPI_Mrecv(bytes.data() + at, count, MPI_BYTE, &message, MPI_STATUS_IGNORE), "MPI_Mrecv");
        } else {
            // Truncated. Not into a short buffer: Open MPI 4.1 writes a whole long message past its end.
            (void)MPI_Mrecv(nullptr, 0, MPI_BYTE, &message, MPI_STATUS_IGNORE);
        }
    }
    return memory;
}

vox_result exchange(const std::uint32_t* ranks, std::uint32_t count, const vox_dist_message* out,
                    vox_dist_message* in, void* user) {
    return border([&] {
        auto& mpi = *static_cast<Duplicate*>(user);
        mpi.requests.clear();
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto* data = static_cast<const std::byte*>(out[i].data);
            for (std::uint64_t sent = 0;; sent += longest) {
                const std::uint64_t bytes = std::min(out[i].size - sent, longest);
                mpi.requests.emplace_back();
                check(MPI_Isend(data + sent, static_cast<int>(bytes), MPI_BYTE, static_cast<int>(ranks[i]),
                                tag, mpi.comm, &mpi.requests.back()),
                      "MPI_Isend");
                if (bytes < longest) break;
            }
        }
        bool memory = true;
        for (std::uint32_t i = 0; i < count; ++i) memory &= receive(mpi, ranks[i], mpi.received[ranks[i]]);
        check(MPI_Waitall(static_cast<int>(mpi.requests.size()), mpi.requests.data(), MPI_STATUSES_IGNORE),
              "MPI_Waitall");
        if (!memory) throw std::bad_alloc();
        for (std::uint32_t i = 0; i < count; ++i)
            in[i] = {mpi.received[ranks[i]].data(), mpi.received[ranks[i]].size()};
    });
}

vox_result agree(std::uint64_t* minima, std::uint32_t minimum_count, std::uint64_t* sums,
                 std::uint32_t sum_count, void* user) {
    return border([&] {
        auto& mpi = *static_cast<Duplicate*>(user);
        Numbers mine{}, all{};
        std::copy_n(minima, minimum_count, mine.of);
        std::copy_n(sums, sum_count, mine.of + 8);
        check(MPI_Allreduce(&mine, &all, 1, mpi.numbers, mpi.combination, mpi.comm), "MPI_Allreduce");
        std::copy_n(all.of, minimum_count, minima);
        std::copy_n(all.of + 8, sum_count, sums);
    });
}

} // namespace
} // namespace vox::mpi

vox_result vox_mpi_transport_create(MPI_Comm comm, vox_dist_transport* out_transport) {
    using namespace vox;
    return border([&] {
        check_out_struct(out_transport, "out_transport");
        int running = 0, ended = 0, between = 0;
        (void)MPI_Initialized(&running);
        (void)MPI_Finalized(&ended);
        if (!running || ended) throw Error(VOX_ERROR_INVALID_STATE, "MPI is not running");
        if (comm == MPI_COMM_NULL) refuse("comm is MPI_COMM_NULL");
        mpi::check(MPI_Comm_test_inter(comm, &between), "MPI_Comm_test_inter");
        if (between) refuse("comm is between two groups");
        int rank = 0, size = 0;
        mpi::check(MPI_Comm_rank(comm, &rank), "MPI_Comm_rank");
        mpi::check(MPI_Comm_size(comm, &size), "MPI_Comm_size");
        auto duplicate = std::make_unique<mpi::Duplicate>(comm);
        duplicate->received.resize(static_cast<std::size_t>(size));
        duplicate->requests.reserve(static_cast<std::size_t>(size));
        const vox_dist_transport transport{sizeof transport,
                                           static_cast<std::uint32_t>(rank),
                                           static_cast<std::uint32_t>(size),
                                           0,
                                           mpi::allgather,
                                           mpi::exchange,
                                           mpi::agree,
                                           duplicate.release()};
        write_struct(out_transport, transport, "out_transport");
    });
}

void vox_mpi_transport_destroy(vox_dist_transport* transport) {
    if (!transport || !transport->user) return;
    delete static_cast<vox::mpi::Duplicate*>(transport->user);
    transport->user = nullptr;
}
