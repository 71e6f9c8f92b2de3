#include "linalg/cholesky.h"

#include "linalg/cholmod_view.h"

#include <assert.h>
#include <dlfcn.h>
#include <string.h>

struct ax_cholesky {
    cholmod_common common;
    cholmod_factor* factor;
    cholmod_dense *y, *e, *x; // workspace kept between solves
    ax_cholesky_counters counters;
};

// Results must not depend on the number of cores, and at our sizes threads cost more than they give. BLAS is told to use one
// thread; CHOLMOD asks OpenMP for four by name, which only forbidding parallel regions can overrule. That setting
// belongs to the calling thread, so it is made again at each call.
static void hold_to_one_thread(void)
{
    static const struct {
        const char* function;
        int argument;
    } settings[] = {
        {"omp_set_max_active_levels", 0}, {"openblas_set_num_threads", 1}, {"bli_thread_set_num_threads", 1}};
    for (size_t k = 0; k < sizeof settings / sizeof *settings; ++k) {
        void* symbol = dlsym(RTLD_DEFAULT, settings[k].function);
        void (*set)(int);
        memcpy(&set, &symbol, sizeof set);
        if (symbol)
            set(settings[k].argument);
    }
}

static ax_cholesky* analyse(const ax_sparse* matrix, const int* order)
{
    hold_to_one_thread();
    ax_cholesky* factor = AX_NEW0(ax_cholesky, 1);
    cholmod_common* common = &factor->common;
    cholmod_start(common);
    common->print = 0;
    common->try_catch = 1;
    common->quick_return_if_not_posdef = 1;
    common->final_ll = 1;
    common->supernodal = CHOLMOD_AUTO;
    // Measured on Laplacians of surfaces: below some 80 operations per entry (10,000 to 20,000 unknowns) columns are quicker
    // than dense blocks; CHOLMOD's own choice is 40.
    common->supernodal_switch = 80;
    // Nested dissection (METIS) saves at most a fifth of the factorisation on surface meshes of up to 500,000 vertices, but
    // takes four to ten times as long as AMD to compute: 2.1 to 3 s against 0.2 to 0.7 s there, for a factorisation of 0.7 s.
    common->nmethods = 1;
    common->method[0].ordering = order ? CHOLMOD_GIVEN : CHOLMOD_AMD;
    common->postorder = 1;
    cholmod_sparse a = ax_cholmod_view(matrix);
    factor->factor = cholmod_analyze_p(&a, (int*)order, NULL, 0, common);
    assert(factor->factor);
    factor->counters.analyses = 1;
    return factor;
}

ax_cholesky* ax_cholesky_analyse(const ax_sparse* matrix)
{
    return analyse(matrix, NULL);
}

ax_cholesky* ax_cholesky_analyse_ordered(const ax_sparse* matrix, const int* order)
{
    return analyse(matrix, order);
}

const int* ax_cholesky_order(const ax_cholesky* factor)
{
    return factor->factor->Perm;
}

void ax_cholesky_free(ax_cholesky* factor)
{
    if (!factor)
        return;
    cholmod_common* common = &factor->common;
    cholmod_free_factor(&factor->factor, common);
    cholmod_free_dense(&factor->y, common);
    cholmod_free_dense(&factor->e, common);
    cholmod_free_dense(&factor->x, common);
    cholmod_finish(common);
    ax_free(factor);
}

bool ax_cholesky_factor(ax_cholesky* factor, const ax_sparse* matrix)
{
    assert((size_t)matrix->n == factor->factor->n);
    cholmod_sparse a = ax_cholmod_view(matrix);
    hold_to_one_thread();
    cholmod_factorize(&a, factor->factor, &factor->common);
    ++factor->counters.factorisations;
    factor->counters.entries = factor->factor->is_super ? (double)factor->factor->xsize : (double)factor->factor->nzmax;
    return factor->common.status == CHOLMOD_OK && factor->factor->minor == factor->factor->n;
}

void ax_cholesky_solve(ax_cholesky* factor, const double* b, double* x, int columns)
{
    size_t n = factor->factor->n;
    cholmod_dense right = {.nrow = n,
                           .ncol = (size_t)columns,
                           .nzmax = n * (size_t)columns,
                           .d = n,
                           .x = (void*)b,
                           .xtype = CHOLMOD_REAL,
                           .dtype = CHOLMOD_DOUBLE};
    hold_to_one_thread();
    cholmod_solve2(CHOLMOD_A, factor->factor, &right, NULL, &factor->x, NULL, &factor->y, &factor->e, &factor->common);
    memcpy(x, factor->x->x, n * (size_t)columns * sizeof *x);
    ++factor->counters.solves;
}

ax_cholesky_counters ax_cholesky_count(const ax_cholesky* factor)
{
    return factor->counters;
}
