#include "design/apart.h"

#include "analysis/measure.h"

ax_status ax_solve_apart(ax_joint_problem* problem, double depth, double (*flat)[2], double (*deployed)[3],
                         const ax_progress* progress, ax_joint_result* result, ax_error* error)
{
    enum { ROUNDS = 5, MOST_PAIRS = 4096 };
    int(*pairs)[2] = ax_alloc(MOST_PAIRS, sizeof *pairs), count = 0, steps = 0;
    ax_status status = AX_OK;
    problem->apart = (const int(*)[2])pairs;
    *result = (ax_joint_result){0};
    for (int round = 0; round < ROUNDS && status == AX_OK; ++round) {
        ax_progress_part slot;
        double lo = 1 - 1.0 / (1 << round); // most are done in the first one: each has half of what remains
        problem->apart_count = count;
        status = ax_joint_solve(problem, flat, deployed, ax_progress_within(&slot, progress, lo, (1 + lo) / 2), result,
                                error);
        steps += result->steps;
        int found = status == AX_OK ? ax_measure_overlaps(problem->linkage, (const double(*)[2])flat, depth,
                                                          MOST_PAIRS - count, pairs + count)
                                    : 0;
        if (found == 0)
            break;
        count = count + found < MOST_PAIRS ? count + found : MOST_PAIRS;
    }
    result->steps = steps;
    problem->apart = NULL, problem->apart_count = 0;
    ax_free(pairs);
    return status;
}
