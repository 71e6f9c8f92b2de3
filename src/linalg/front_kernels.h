// The arithmetic of fronts, for vectors of LANES doubles: included once for each width of vectors, with NAME(x) naming what belongs to
// it and TARGET what lets the compiler use it. Entries meet the same operations in the same order in all of them.
typedef double NAME(vector) __attribute__((vector_size(8 * LANES)));
typedef double NAME(loose) __attribute__((vector_size(8 * LANES), aligned(8)));

// entry[row .. end, j .. j + W) -= sum over k of entry[:, k] entry[j .. j + W, k], a whole number of vectors. Rows above the
// diagonal get values that nobody reads.
#define UPDATE(W)                                                                                                      \
    TARGET static void NAME(update_##W)(const front* f, int j, int row, int end)                                       \
    {                                                                                                                  \
        double* column = f->entry + (size_t)j * f->stride;                                                             \
        for (; row + 2 * LANES <= end; row += 2 * LANES) {                                                             \
            NAME(vector) a[W], b[W];                                                                                   \
            for (int c = 0; c < W; ++c) {                                                                              \
                a[c] = *(NAME(vector)*)(column + (size_t)c * f->stride + row);                                         \
                b[c] = *(NAME(vector)*)(column + (size_t)c * f->stride + row + LANES);                                 \
            }                                                                                                          \
            const double* at = f->entry + (size_t)f->from * f->stride;                                                 \
            for (int k = f->from; k < f->to; ++k, at += f->stride) {                                                   \
                NAME(vector) p = *(const NAME(vector)*)(at + row), q = *(const NAME(vector)*)(at + row + LANES);       \
                for (int c = 0; c < W; ++c) {                                                                          \
                    a[c] -= p * at[j + c];                                                                             \
                    b[c] -= q * at[j + c];                                                                             \
                }                                                                                                      \
            }                                                                                                          \
            for (int c = 0; c < W; ++c) {                                                                              \
                *(NAME(vector)*)(column + (size_t)c * f->stride + row) = a[c];                                         \
                *(NAME(vector)*)(column + (size_t)c * f->stride + row + LANES) = b[c];                                 \
            }                                                                                                          \
        }                                                                                                              \
        if (row < end) {                                                                                               \
            NAME(vector) a[W];                                                                                         \
            for (int c = 0; c < W; ++c)                                                                                \
                a[c] = *(NAME(vector)*)(column + (size_t)c * f->stride + row);                                         \
            const double* at = f->entry + (size_t)f->from * f->stride;                                                 \
            for (int k = f->from; k < f->to; ++k, at += f->stride)                                                     \
                for (int c = 0; c < W; ++c)                                                                            \
                    a[c] -= *(const NAME(vector)*)(at + row) * at[j + c];                                              \
            for (int c = 0; c < W; ++c)                                                                                \
                *(NAME(vector)*)(column + (size_t)c * f->stride + row) = a[c];                                         \
        }                                                                                                              \
    }
UPDATE(1)
UPDATE(2)
UPDATE(3)
UPDATE(4)
#undef UPDATE

static void NAME(update_columns)(const front* f, int from, int to, int row, int end)
{
    static void (*const kernel[])(const front*, int, int, int) = {NULL, NAME(update_1), NAME(update_2), NAME(update_3),
                                                                  NAME(update_4)};
    for (int j = from; j < to; j += 4)
        kernel[to - j < 4 ? to - j : 4](f, j, j > row ? j / ROUND * ROUND : row, end);
}

// LANES columns from j on, in the rows of one strip: what the kernels above do, in the same order, but reading memory as it lies.
TARGET static void NAME(update_strip)(const front* f, int strip, int j)
{
    int depth = f->to - f->from;
    for (int part = 0; part < STRIP; part += 2 * LANES) {
        const double* a = f->packed + (size_t)strip * BLOCK * STRIP + part;
        const double* b = f->packed + (size_t)((j - f->first) / STRIP) * BLOCK * STRIP + (j - f->first) % STRIP;
        double* column = f->entry + (size_t)j * f->stride + f->first + strip * STRIP + part;
        NAME(vector) lower[LANES], upper[LANES];
        for (int c = 0; c < LANES; ++c) {
            lower[c] = *(NAME(loose)*)(column + (size_t)c * f->stride);
            upper[c] = *(NAME(loose)*)(column + (size_t)c * f->stride + LANES);
        }
        for (int k = 0; k < depth; ++k, a += STRIP, b += STRIP) {
            NAME(vector) p = *(const NAME(vector)*)a, q = *(const NAME(vector)*)(a + LANES);
            for (int c = 0; c < LANES; ++c) {
                lower[c] -= p * b[c];
                upper[c] -= q * b[c];
            }
        }
        for (int c = 0; c < LANES; ++c) {
            *(NAME(loose)*)(column + (size_t)c * f->stride) = lower[c];
            *(NAME(loose)*)(column + (size_t)c * f->stride + LANES) = upper[c];
        }
    }
}

static void NAME(update_task)(void* context, int task)
{
    const front* f = context;
    int from = f->first + task * COLUMNS_PER_TASK;
    int to = from + COLUMNS_PER_TASK < f->size ? from + COLUMNS_PER_TASK : f->size;
    int whole = from + (to - from) / LANES * LANES;
    for (int strip = (from - f->first) / STRIP; strip < strip_count(f); ++strip)
        for (int j = from; j < whole; j += LANES)
            NAME(update_strip)(f, strip, j);
    NAME(update_columns)(f, whole, to, 0, rows_stored(f));
}

// Rows of columns j .. j + width - 1, below their triangle and up to date with all columns before.
TARGET static void NAME(eliminate_rows)(const front* f, int j, int width, int row, int end)
{
    double *column[4], scale[4];
    for (int c = 0; c < width; ++c) {
        column[c] = f->entry + (size_t)(j + c) * f->stride;
        scale[c] = 1 / column[c][j + c];
    }
    for (; row < end && row % LANES; ++row)
        for (int c = 0; c < width; ++c) {
            for (int b = 0; b < c; ++b)
                column[c][row] -= column[b][row] * column[b][j + c];
            column[c][row] *= scale[c];
        }
    for (; row < end; row += LANES)
        for (int c = 0; c < width; ++c) {
            NAME(vector) sum = *(NAME(vector)*)(column[c] + row);
            for (int b = 0; b < c; ++b)
                sum -= *(NAME(vector)*)(column[b] + row) * column[b][j + c];
            *(NAME(vector)*)(column[c] + row) = sum * scale[c];
        }
}

static const kernels NAME(kernels) = {NAME(update_columns), NAME(update_task), NAME(eliminate_rows)};

#undef NAME
#undef LANES
#undef TARGET
