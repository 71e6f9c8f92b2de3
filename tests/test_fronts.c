// The dense arithmetic of the sparse factor: vectors of either width give the bits of the other.
#include "linalg/panels_factor.c"

#include "base/random.h"
#include "support/test.h"

// The lower triangle of a front, its first columns eliminated.
static double* factored(const kernels* by, int size, int width, ax_pool* pool)
{
    ax_supernode node = {.width = width, .rows = size - width};
    int failed = -1;
    front f = {.kernels = by, .stride = ax_front_stride(&node), .size = size, .failed = &failed};
    size_t count = f.stride * (size_t)size;
    double* packed = ax_alloc_aligned(BLOCK * (size_t)(size + STRIP), sizeof *packed);
    f.entry = ax_alloc_aligned(count, sizeof *f.entry);
    f.packed = packed;
    memset(f.entry, 0, count * sizeof *f.entry);
    ax_random random = {(uint64_t)size};
    for (int j = 0; j < size; ++j)
        for (int i = j; i < size; ++i)
            f.entry[(size_t)j * f.stride + (size_t)i] = i == j ? size : ax_random_uniform(&random, -1, 1);
    factor_front(&f, width, pool);
    assert_int_equal(failed, -1);
    for (int j = 0; j < size; ++j) // above the diagonal there is what nobody reads
        memset(f.entry + (size_t)j * f.stride, 0, (size_t)j * sizeof *f.entry);
    ax_free(packed);
    return f.entry;
}

static void every_width_of_vectors_gives_the_same_bits(void** state)
{
    (void)state;
    static const int size[][2] = {{1, 1}, {7, 3}, {21, 6}, {64, 64}, {129, 1}, {200, 67}, {333, 333}, {400, 131}};
    ax_pool* pool = ax_pool_make(2);
    for (size_t k = 0; k < sizeof size / sizeof *size; ++k) {
        ax_supernode node = {.width = size[k][1], .rows = size[k][0] - size[k][1]};
        size_t bytes = ax_front_stride(&node) * (size_t)size[k][0] * sizeof(double);
        double *narrow = factored(&kernels_by_4, size[k][0], size[k][1], NULL),
               *wide = factored(best_kernels(), size[k][0], size[k][1], pool);
        assert_memory_equal(narrow, wide, bytes);
        ax_free(narrow);
        ax_free(wide);
    }
    ax_pool_free(pool);
}

// L L' is the matrix again.
static void a_front_is_a_cholesky_factor(void** state)
{
    (void)state;
    enum { SIZE = 150 };
    ax_supernode node = {.width = SIZE};
    size_t stride = ax_front_stride(&node);
    double* l = factored(best_kernels(), SIZE, SIZE, NULL);
    ax_random random = {SIZE};
    for (int j = 0; j < SIZE; ++j)
        for (int i = j; i < SIZE; ++i) {
            double sum = 0, given = i == j ? SIZE : ax_random_uniform(&random, -1, 1);
            for (int k = 0; k <= j; ++k)
                sum += l[(size_t)k * stride + (size_t)i] * l[(size_t)k * stride + (size_t)j];
            assert_near(sum, given, 1e-11);
        }
    ax_free(l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_width_of_vectors_gives_the_same_bits),
        cmocka_unit_test(a_front_is_a_cholesky_factor),
    };
    return cmocka_run_group_tests_name("fronts", tests, NULL, NULL);
}
