// BoomerAMG of hypre [Henson02] in this process alone.

#include "lamella/linalg/detail/multigrid.h"

#define OMPI_SKIP_MPICXX  // the C++ bindings of MPI would need a library of their own
#define MPICH_SKIP_MPICXX
#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>
#include <mpi.h>

#include <cstdlib>
#include <numeric>
#include <vector>

namespace lamella::linalg::detail {
namespace {

/// hypre counts on MPI being there; where nobody has started it, this process is a world of its own.
void start_hypre() {
    static const bool started = [] {
        int mpi = 0;
        MPI_Initialized(&mpi);
        if (mpi == 0) {
            MPI_Init(nullptr, nullptr);
            std::atexit([] {
                int over = 0;
                MPI_Finalized(&over);
                if (over == 0) MPI_Finalize();
            });
        }
        HYPRE_Init();
        return true;
    }();
    (void)started;
}

/// Both triangles of a matrix by rows.
struct Rows {
    std::vector<HYPRE_Int> length;
    std::vector<HYPRE_BigInt> number, column;
    std::vector<HYPRE_Complex> value;

    explicit Rows(const SymmetricMatrix& m) : length(m.size(), 0), number(m.size()) {
        const auto for_each = [&](auto&& entry) {
            for (std::size_t j = 0; j < m.size(); ++j)
                for (int k = m.column_start[j]; k < m.column_start[j + 1]; ++k) {
                    const auto slot = static_cast<std::size_t>(k);
                    const auto i = static_cast<std::size_t>(m.row[slot]);
                    entry(i, j, m.value[slot]);
                    if (i != j) entry(j, i, m.value[slot]);
                }
        };
        for_each([&](std::size_t i, std::size_t, double) { ++length[i]; });
        std::vector<std::size_t> place(m.size());
        std::exclusive_scan(length.begin(), length.end(), place.begin(), std::size_t{0});
        const std::size_t entries = m.size() == 0 ? 0 : place.back() + static_cast<std::size_t>(length.back());
        column.resize(entries);
        value.resize(entries);
        for_each([&](std::size_t i, std::size_t j, double a) {
            column[place[i]] = static_cast<HYPRE_BigInt>(j);
            value[place[i]++] = a;
        });
        std::iota(number.begin(), number.end(), HYPRE_BigInt{0});
    }
};

class Vector {
public:
    explicit Vector(std::size_t size) : numbers_(size) {
        std::iota(numbers_.begin(), numbers_.end(), HYPRE_BigInt{0});
        HYPRE_IJVectorCreate(MPI_COMM_SELF, 0, static_cast<HYPRE_BigInt>(size) - 1, &vector_);
        HYPRE_IJVectorSetObjectType(vector_, HYPRE_PARCSR);
        HYPRE_IJVectorInitialize(vector_);
        HYPRE_IJVectorAssemble(vector_);
    }
    ~Vector() { HYPRE_IJVectorDestroy(vector_); }
    Vector(const Vector&) = delete;
    Vector& operator=(const Vector&) = delete;

    void set(std::span<const double> x) {
        HYPRE_IJVectorSetValues(vector_, size(), numbers_.data(), x.data());
        HYPRE_IJVectorAssemble(vector_);
    }
    void get(std::span<double> x) const { HYPRE_IJVectorGetValues(vector_, size(), numbers_.data(), x.data()); }
    HYPRE_ParVector object() const {
        void* object = nullptr;
        HYPRE_IJVectorGetObject(vector_, &object);
        return static_cast<HYPRE_ParVector>(object);
    }

private:
    HYPRE_Int size() const { return static_cast<HYPRE_Int>(numbers_.size()); }

    std::vector<HYPRE_BigInt> numbers_;
    HYPRE_IJVector vector_ = nullptr;
};

class HypreMultigrid final : public Multigrid {
public:
    explicit HypreMultigrid(const SymmetricMatrix& matrix) : right_(matrix.size()), solution_(matrix.size()) {
        take(Rows(matrix));
        HYPRE_BoomerAMGCreate(&grids_);
        HYPRE_BoomerAMGSetPrintLevel(grids_, 0);
        HYPRE_BoomerAMGSetCoarsenType(grids_, 10);  // HMIS
        HYPRE_BoomerAMGSetInterpType(grids_, 6);    // extended+i
        HYPRE_BoomerAMGSetPMaxElmts(grids_, 4);
        HYPRE_BoomerAMGSetStrongThreshold(grids_, 0.25);  // of films, which are surfaces
        HYPRE_BoomerAMGSetRelaxType(grids_, 8);           // symmetric Gauss-Seidel, as conjugate gradients need
        HYPRE_BoomerAMGSetMaxIter(grids_, 1);
        HYPRE_BoomerAMGSetTol(grids_, 0.0);
        sound_ = HYPRE_BoomerAMGSetup(grids_, object(), right_.object(), solution_.object()) == 0;
        HYPRE_ClearAllErrors();
    }
    ~HypreMultigrid() override {
        HYPRE_BoomerAMGDestroy(grids_);
        HYPRE_IJMatrixDestroy(matrix_);
    }
    HypreMultigrid(const HypreMultigrid&) = delete;
    HypreMultigrid& operator=(const HypreMultigrid&) = delete;

    bool sound() const { return sound_; }

    void cycle(std::span<const double> x, std::span<double> result) const override {
        right_.set(x);
        HYPRE_ParVectorSetConstantValues(solution_.object(), 0.0);
        HYPRE_BoomerAMGSolve(grids_, object(), right_.object(), solution_.object());
        HYPRE_ClearAllErrors();  // one cycle does not converge, and says so
        solution_.get(result);
    }

private:
    void take(const Rows& rows) {
        const auto size = static_cast<HYPRE_BigInt>(rows.number.size());
        HYPRE_IJMatrixCreate(MPI_COMM_SELF, 0, size - 1, 0, size - 1, &matrix_);
        HYPRE_IJMatrixSetObjectType(matrix_, HYPRE_PARCSR);
        HYPRE_IJMatrixSetRowSizes(matrix_, rows.length.data());
        HYPRE_IJMatrixInitialize(matrix_);
        std::vector<HYPRE_Int> length = rows.length;
        HYPRE_IJMatrixSetValues(matrix_, static_cast<HYPRE_Int>(size), length.data(), rows.number.data(),
                                rows.column.data(), rows.value.data());
        HYPRE_IJMatrixAssemble(matrix_);
    }
    HYPRE_ParCSRMatrix object() const {
        void* object = nullptr;
        HYPRE_IJMatrixGetObject(matrix_, &object);
        return static_cast<HYPRE_ParCSRMatrix>(object);
    }

    HYPRE_IJMatrix matrix_ = nullptr;
    mutable Vector right_, solution_;
    HYPRE_Solver grids_ = nullptr;
    bool sound_ = false;
};

}  // namespace

bool has_multigrid() { return true; }

std::unique_ptr<Multigrid> make_multigrid(const SymmetricMatrix& matrix) {
    start_hypre();
    auto multigrid = std::make_unique<HypreMultigrid>(matrix);
    if (!multigrid->sound()) return nullptr;
    return multigrid;
}

}  // namespace lamella::linalg::detail
