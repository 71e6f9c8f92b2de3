// Settling: both states until they rest.
#include "form/state.h"

#include "analysis/measure.h"
#include "base/vec.h"
#include "solver/extrapolate.h"

#include <math.h>
#include <string.h>

enum {
    FRESH_ITERATIONS = 100,
    LEAN_ITERATIONS = 200,
    FLAT_ITERATIONS = 400,
    SHAPE_ITERATIONS = 650,
    LOAD_ITERATIONS = 400,
    MOST_ITERATIONS = 2000,
    REST_CHECK = 25,
    BLOCK = 15, // iterations between two states of which the limit is taken
    BLOCKS = 5, // until only slow modes are left
    STATES = 5,
    TURNS = 4,         // of a sheet in its rim, at most
    FIRST_TURN = 2500, // blocks of iterations that it stands for
    CALM = 8,          // blocks until what it stirred up has died down
    LAST_CALM = 4,     // the same, of the last turn, which is small
    STALLED = 450      // iterations without better edges: they cannot be right
};
static const double rest_error = 1e-4, rest_step = 1e-5, near_error = 2e-3, good_error = 5e-3, balance_error = 0.03;
static const double block_step = 1e-4;  // in lattice spacings
static const double turn_step = 1e-5;   // the same, on the sheet's radius
static const double calm_step = 2e-6;   // too slow to matter, and as slow as the rest comes to rest
static const double widest_turn = 0.1;  // radians, at once
static const double early_turn = 0.02;  // the same: stirs up so much that it is made while the shape is still found
static const double early_step = 3e-3;  // in lattice spacings, by then
static const double steady = 0.1;       // of its rate, by which the rate of a turn changes in a block
static const double coarse_share = 0.3; // of the time, where a coarser sheet settles first
static const double first_share = 0.8;  // of what is left, where a fresh sheet may have to rest twice
static const double far_move = 0.08;    // of the sheet's radius, by a stroke
static const double popped = 0.1;       // of the sheet's radius, moved under load
static const double astray = 4;         // steps so many times longer after a jump than before it: it is taken back
static const double new_folds = 0.002;  // of the hinges
static const char shaping[] = "Shaping the sheet", loading[] = "Loading the sheet";

// States as they were before a call that is cancelled.
typedef struct snapshot {
    double (*flat)[2], (*deployed)[3], (*simulated)[3], (*side)[3], (*drawn)[3], *multipliers, growth;
    void* coarser;
    size_t count, coarser_size;
    bool outdated, lightly;
    int iterations;
} snapshot;

static snapshot keep(const ax_form* f)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    snapshot s = {.flat = ax_copy(f->flat, n, sizeof *f->flat),
                  .deployed = ax_copy(f->deployed, n, sizeof *f->deployed),
                  .simulated = ax_copy(f->simulated, n, sizeof *f->simulated),
                  .side = ax_copy(f->side, (size_t)f->lattice.linkage.triangle_count, sizeof *f->side),
                  .drawn = f->drawn ? ax_copy(f->drawn, n, sizeof *f->drawn) : NULL,
                  .growth = f->growth,
                  .iterations = f->iterations};
    s.multipliers = ax_form_multipliers(f, &s.count);
    s.coarser = f->coarser ? ax_form_save(f->coarser, &s.coarser_size) : NULL;
    s.outdated = f->outdated;
    s.lightly = f->lightly;
    return s;
}

static void restore(ax_form* f, snapshot* s)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    memcpy(f->flat, s->flat, n * sizeof *f->flat);
    memcpy(f->deployed, s->deployed, n * sizeof *f->deployed);
    memcpy(f->simulated, s->simulated, n * sizeof *f->simulated);
    memcpy(f->side, s->side, (size_t)f->lattice.linkage.triangle_count * sizeof *f->side);
    ax_free(f->drawn);
    f->drawn = s->drawn;
    s->drawn = NULL;
    ax_form_free(f->coarser);
    f->coarser = NULL;
    if (s->coarser)
        ax_form_load(s->coarser, s->coarser_size, &f->coarser, NULL); // as it was saved, so it loads
    f->outdated = s->outdated;
    f->lightly = s->lightly;
    f->growth = s->growth;
    f->iterations = s->iterations;
    ax_form_drop_solvers(f);
    ax_free(f->pending);
    f->pending = s->multipliers;
    f->pending_count = s->count;
    s->multipliers = NULL;
}

static void forget(snapshot* s)
{
    ax_free(s->flat);
    ax_free(s->deployed);
    ax_free(s->simulated);
    ax_free(s->side);
    ax_free(s->drawn);
    ax_free(s->multipliers);
    ax_free(s->coarser);
}

static double shape_error(const ax_form* f)
{
    return fmax(ax_form_flat_error(f), ax_form_shares(f) ? ax_form_deployed_error(f) : 0);
}

// Iterates one of the two until its edges are right and it rests, or for `least` iterations, and on to `most` while edges are off.
// False if cancelled.
static bool run(ax_form* f, bool shape, int least, int most, const ax_progress* progress, double lo, double hi)
{
    for (int done = 0; done < most;) {
        int count = REST_CHECK < most - done ? REST_CHECK : most - done;
        f->scaled_step = 0;
        if (shape)
            ax_form_iterate_shape(f, count);
        else
            ax_form_iterate_hang(f, count);
        done += count;
        f->iterations += count;
        double off = shape ? shape_error(f) : ax_form_simulated_error(f);
        if (!ax_progress_report(progress, shape ? shaping : loading, lo + (hi - lo) * done / most, off))
            return false;
        if ((off < rest_error && f->scaled_step < rest_step) || (done >= least && off < good_error))
            return true;
    }
    return true;
}

// What the shape's iterations hand from one to the next: places of both states and multipliers.
static size_t shape_size(const ax_form* f)
{
    return 5 * (size_t)f->lattice.linkage.hinge_count + ax_solver_multiplier_count(f->shape);
}

static void take_shape(const ax_form* f, double* z)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    memcpy(z, f->flat, n * sizeof *f->flat);
    memcpy(z + 2 * n, f->deployed, n * sizeof *f->deployed);
    ax_solver_get_multipliers(f->shape, z + 5 * n);
}

static void put_shape(ax_form* f, const double* z)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    memcpy(f->flat, z, n * sizeof *f->flat);
    memcpy(f->deployed, z + 2 * n, n * sizeof *f->deployed);
    ax_solver_set_multipliers(f->shape, z + 5 * n);
}

// Whether nothing but the slope of its rim keeps the sheet from turning: then it may go far, at a steady rate.
static bool may_turn(const ax_form* f)
{
    for (int k = 0; k < f->rim_count; ++k)
        if (f->rim[k].kind == AX_RIM_FIXED)
            return false;
    return f->held_count == 0;
}

// Of the rate at which the last block turned it, how far that is likely to go.
static double whole_turn(double rate)
{
    return ax_clamp(FIRST_TURN * rate, -widest_turn, widest_turn);
}

// Both states of the shape. Edges are right after one or two hundred iterations; a few slow modes are left, of which a block of iterations
// keeps nine tenths: the limit of some states a block apart takes them away at once. A turn in the rim, which would go on for long, is made as
// soon as it is steady. False if cancelled.
static bool shape_sheet(ax_form* f, const ax_progress* progress, double hi)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    ax_extrapolation* states = ax_extrapolation_make(shape_size(f), STATES);
    double(*was)[3] = ax_copy(f->deployed, n, sizeof *was), before = INFINITY, best = INFINITY;
    double rate = 0;
    int bettered = 0;
    bool going = true, jumped = false, turns = may_turn(f);
    for (int done = 0, blocks = 0; done < MOST_ITERATIONS && going; done += BLOCK) {
        ax_form_iterate_shape(f, BLOCK);
        f->iterations += BLOCK;
        double off = shape_error(f),
               moved = ax_measure_move((int)n, (const double(*)[3])was, (const double(*)[3])f->deployed) /
                       f->lattice.spacing;
        going = ax_progress_report(progress, shaping, hi * done / MOST_ITERATIONS, off);
        if (off < 0.95 * best)
            best = off, bettered = done;
        if ((off < rest_error && moved < block_step) ||
            (done >= SHAPE_ITERATIONS && (off < good_error || done - bettered >= STALLED)))
            break;
        double turned = turns ? ax_measure_turn((int)n, (const double(*)[3])was, (const double(*)[3])f->deployed) : 0;
        bool steadily = fabs(turned - rate) < steady * fabs(turned);
        if (turns && steadily && !jumped && moved < early_step && fabs(whole_turn(turned)) > early_turn) {
            ax_measure_turned((int)n, (const double(*)[3])f->deployed, whole_turn(turned), f->deployed);
            ax_measure_turned((int)n, (const double(*)[3])f->simulated, whole_turn(turned), f->simulated);
            ax_extrapolation_clear(states);
            blocks = 0;
            turns = false; // the rest of it at the end
        }
        rate = turned;
        if (jumped && moved > astray * before)
            put_shape(f, ax_extrapolation_last(states));
        jumped = false;
        if (++blocks > BLOCKS && done + BLOCK < MOST_ITERATIONS) { // what is left after a jump is iterated
            take_shape(f, ax_extrapolation_next(states));
            const double* limit = ax_extrapolation_limit(states);
            if (limit) {
                put_shape(f, limit);
                jumped = true;
                before = moved;
                blocks = BLOCKS - 1; // what the jump stirs up dies down first
            }
        }
        memcpy(was, f->deployed, n * sizeof *was);
    }
    ax_free(was);
    ax_extrapolation_free(states);
    return going;
}

// Iterates `blocks`, and takes by how much the last of them turned the sheet. False if cancelled.
static bool turn_of_blocks(ax_form* f, int blocks, const ax_progress* progress, double gone, double* turn)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    double(*was)[3] = ax_alloc(n, sizeof *was);
    bool going = true;
    for (int k = 0; k < blocks && going; ++k) {
        memcpy(was, f->deployed, n * sizeof *was);
        ax_form_iterate_shape(f, BLOCK);
        f->iterations += BLOCK;
        going = ax_progress_report(progress, shaping, gone, shape_error(f));
    }
    *turn = ax_measure_turn((int)n, (const double(*)[3])was, (const double(*)[3])f->deployed);
    ax_free(was);
    return going;
}

// A sheet turns in a rim that is nearly round, by next to no force and for thousands of iterations. Where it stops is found by secants: it is
// turned, what that stirs up dies down, and it is seen how fast it turns there. Where it turns most slowly it stays, and what is under load
// turns with it. False if cancelled.
static bool end_turn(ax_form* f, const ax_progress* progress, double gone)
{
    int n = f->lattice.linkage.hinge_count;
    double(*from)[3] = ax_copy(f->deployed, (size_t)n, sizeof *from), *best = AX_NEW(double, shape_size(f));
    double size = f->lattice.spacing / f->radius, rate, angle = 0;
    bool going = turn_of_blocks(f, 1, progress, gone, &rate), drawn = true;
    double turn = whole_turn(rate), slowest = fabs(rate);
    take_shape(f, best);
    for (int k = 0; k < TURNS && going && drawn && fabs(rate) > turn_step * size; ++k) {
        ax_measure_turned(n, (const double(*)[3])f->deployed, turn, f->deployed);
        double now;
        going = turn_of_blocks(f, CALM, progress, gone, &now);
        double at = ax_measure_turn(n, (const double(*)[3])from, (const double(*)[3])f->deployed);
        double slope = (now - rate) / (at - angle);
        rate = now, angle = at;
        if (fabs(now) < slowest) {
            slowest = fabs(now);
            take_shape(f, best);
        }
        drawn = slope < 0; // back to where it stops
        turn = drawn ? ax_clamp(-now / slope, -widest_turn, widest_turn) : 0;
    }
    if (going && fabs(rate) > slowest) {
        put_shape(f, best);
    } else if (going && drawn && fabs(rate) <= turn_step * size && fabs(rate) > calm_step * size) {
        ax_measure_turned(n, (const double(*)[3])f->deployed, turn, f->deployed);
        going = turn_of_blocks(f, LAST_CALM, progress, gone, &rate);
        angle += turn;
    }
    if (angle != 0) {
        double turned = ax_measure_turn(n, (const double(*)[3])from, (const double(*)[3])f->deployed);
        ax_measure_turned(n, (const double(*)[3])f->simulated, turned, f->simulated);
    }
    ax_free(best);
    ax_free(from);
    return going;
}

// Near the rest and then to it. False if cancelled.
static bool come_to_rest(ax_form* f, const ax_progress* progress, double lo, double hi, bool* balanced)
{
    ax_progress_part part;
    const ax_progress* rest = ax_progress_within(&part, progress, (lo + hi) / 2, hi);
    double load = ax_form_load_per_area(f);
    *balanced = false;
    // projective steps stray from where a slack part lies to where it might lie too
    if (ax_form_simulated_error(f) < near_error && (!ax_form_balance(f, load, rest, balanced) || *balanced))
        return *balanced;
    return run(f, false, LOAD_ITERATIONS, LOAD_ITERATIONS, progress, lo, (lo + hi) / 2) &&
           (ax_form_simulated_error(f) > balance_error || ax_form_balance(f, load, rest, balanced));
}

static void load_from(ax_form* f, const double (*x)[3])
{
    memcpy(f->simulated, x, (size_t)f->lattice.linkage.hinge_count * sizeof *f->simulated);
    ax_solver_reset_multipliers(f->hang);
}

// For given iterations; 0: until forces are in balance. From where it is, so that slack parts stay as they lie, or afresh from the open shape,
// whose edges are right; where it does not rest from the one, from the other. False if cancelled.
static bool load_sheet(ax_form* f, int iterations, bool afresh, const ax_progress* progress)
{
    if (iterations > 0)
        return run(f, false, iterations, iterations, progress, 0.5, 1);
    bool shares = ax_form_shares(f), balanced;
    double(*other)[3] =
        ax_copy(afresh ? f->simulated : f->deployed, (size_t)f->lattice.linkage.hinge_count, sizeof *other);
    if (afresh && shares)
        load_from(f, (const double(*)[3])f->deployed);
    bool going = come_to_rest(f, progress, 0.5, 0.65, &balanced),
         right = !shares || shape_error(f) <= good_error; // else nor can it be under load
    if (going && !balanced && shares && right) {
        load_from(f, (const double(*)[3])other);
        going = come_to_rest(f, progress, 0.65, 0.8, &balanced);
    }
    ax_free(other);
    return going && (balanced || !right || run(f, false, LOAD_ITERATIONS, MOST_ITERATIONS, progress, 0.8, 1));
}

// Iterations of the shape under all of its load. False if cancelled.
static bool lean_on(ax_form* f, int iterations, const ax_progress* progress, double gone)
{
    bool going = true;
    f->opens = true;
    for (int done = 0; done < iterations && going; done += REST_CHECK) {
        ax_form_iterate_shape(f, REST_CHECK < iterations - done ? REST_CHECK : iterations - done);
        going = ax_progress_report(progress, shaping, gone, shape_error(f));
    }
    f->opens = false;
    return going;
}

// Opens a sheet that is nearly flat, or takes the places of a coarser one that has opened: then so much of the time has gone by. False if
// cancelled.
static bool start_afresh(ax_form* f, int iterations, const ax_progress* progress, double* gone)
{
    ax_progress_part part;
    bool nested = false;
    if (iterations == 0 && !ax_form_nest(f, ax_progress_within(&part, progress, 0, coarse_share), &nested))
        return false;
    *gone = nested ? coarse_share : 0;
    if (nested)
        ax_form_start_at_nest(f);
    // Panels that give way before the holes are open settle for a flatter shape, and leave it slowly. All of the load leans on the sheet until they
    // have given way: what is left over folds as the load has it, not as the lattice does.
    int share = iterations / 4;
    if (!nested) {
        ax_form_allow_give(f, false);
        bool going = lean_on(f, iterations > 0 ? share : FRESH_ITERATIONS, progress, *gone);
        ax_form_allow_give(f, true);
        if (!going)
            return false;
    }
    return !(ax_form_hangs(f) && ax_form_shares(f)) ||
           lean_on(f, iterations > 0 ? share : LEAN_ITERATIONS, progress, *gone);
}

// Both states at rest. False if cancelled.
static bool rest(ax_form* f, int iterations, bool afresh, const ax_progress* progress)
{
    double half = ax_form_hangs(f) ? 0.5 : 1;
    bool going;
    if (iterations == 0 && ax_form_shares(f))
        going = shape_sheet(f, progress, half) && (shape_error(f) > rest_error || end_turn(f, progress, half));
    else
        going = run(f, true, iterations > 0 ? iterations : FLAT_ITERATIONS,
                    iterations > 0 ? iterations : MOST_ITERATIONS, progress, 0, half);
    ax_form_measure_sides(f);
    return going && (!ax_form_hangs(f) || load_sheet(f, iterations, afresh, progress));
}

static double farthest_move(const ax_form* f, const double (*from)[3])
{
    double most = 0;
    for (int h = 0; h < f->lattice.linkage.hinge_count; ++h)
        most = fmax(most, ax_distance3(from[h], f->deployed[h]));
    return most;
}

// Whether a part of a sheet that is held all the way round bulged against its load, and has turned over under it.
static bool has_popped(const ax_form* f)
{
    return farthest_move(f, (const double(*)[3])f->simulated) > popped * f->radius && ax_form_hangs(f) &&
           ax_form_shares(f) && ax_form_held_all_round(f);
}

static int count_folds(const ax_form* f)
{
    return ax_form_folds(f, (const double(*)[3])f->deployed, NULL);
}

// More panels are folded onto each other than a start afresh has left in corners, and would leave again.
static bool has_folded(const ax_form* f)
{
    return count_folds(f) > f->folds + new_folds * f->lattice.linkage.hinge_count;
}

// A sheet that rests elsewhere than the coarser one goes back to where that does, and is drawn to it. `from`: where it was before a stroke,
// NULL: it started afresh. False if cancelled.
static bool keep_to_nest(ax_form* f, const double (*from)[3], const ax_progress* progress)
{
    ax_progress_part part;
    bool nested, going = true;
    // what has moved far may have folded in another way
    if (from && !f->drawn && ax_form_may_fold(f) && ax_form_shares(f) && farthest_move(f, from) > far_move * f->radius)
        going = ax_form_nest(f, ax_progress_within(&part, progress, 0, coarse_share), &nested);
    if (going && ax_form_draw_to_nest(f))
        going = rest(f, 0, true, ax_progress_within(&part, progress, coarse_share, 0.65));
    // where the coarser sheet's edges are right, this one's can be
    if (going && f->drawn && shape_error(f) > good_error && shape_error(f->coarser) <= good_error &&
        ax_form_draw_lightly(f))
        going = rest(f, 0, true, ax_progress_within(&part, progress, 0.65, 1));
    return going;
}

ax_status ax_form_settle(ax_form* f, int iterations, const ax_progress* progress, ax_error* error)
{
    int n = f->lattice.linkage.hinge_count;
    ax_status held = ax_form_hangs(f) ? ax_form_check_support(f, error) : AX_OK;
    if (held != AX_OK)
        return held;
    ax_form_end_drag(f);
    snapshot before = keep(f);
    ax_form_build(f);
    // The flat state starts from the twist of its factors, so that it does not depend on the way here; the deployed one starts
    // out of the plane, where it would stay locked, and afresh where panels have folded onto each other or turned over, which would not
    // come back, and where what holds the rim is elsewhere now.
    ax_form_twist(f);
    if (!ax_form_shares(f))
        ax_solver_reset_multipliers(f->shape);
    bool fresh = false, going = true;
    double lo = INFINITY, hi = -INFINITY;
    for (int h = 0; h < n; ++h)
        lo = fmin(lo, f->deployed[h][2]), hi = fmax(hi, f->deployed[h][2]);
    bool folded = ax_form_shares(f) && (has_folded(f) || ax_form_left_over(f) || ax_form_stands_elsewhere(f));
    if (f->dynamics.kind != AX_DYNAMICS_NONE && (hi - lo < 1e-6 * f->radius || folded))
        ax_form_open(f, 0.05), fresh = true;
    double from = 0;
    if (fresh || !ax_form_may_fold(f) || !ax_form_shares(f))
        ax_form_let_go(f);
    if (fresh)
        going = start_afresh(f, iterations, progress, &from);
    ax_progress_part part;
    bool nested;
    if (f->drawn && iterations == 0) {
        going = ax_form_nest(f, ax_progress_within(&part, progress, 0, coarse_share), &nested);
        if (going)
            ax_form_follow_nest(f);
        from = coarse_share;
    }
    double to = fresh ? from + first_share * (1 - from) : 1;
    going = going && rest(f, iterations, fresh, ax_progress_within(&part, progress, from, to));
    if (going && fresh && iterations == 0 && has_popped(f)) { // it opens again, from where it hangs
        memcpy(f->deployed, f->simulated, (size_t)n * sizeof *f->deployed);
        going = rest(f, 0, true, ax_progress_within(&part, progress, to, (to + 1) / 2));
    }
    if (going && iterations == 0)
        going = keep_to_nest(f, fresh ? NULL : (const double(*)[3])before.deployed,
                             ax_progress_within(&part, progress, (to + 1) / 2, 1));
    ax_form_leave_nest(f);
    if (going)
        f->turned = ax_form_turns_over(f), f->folds = fresh ? count_folds(f) : f->folds;
    else
        restore(f, &before), f->apart = 0;
    forget(&before);
    f->exact = false;
    ++f->revision;
    return going ? AX_OK : ax_fail(error, AX_CANCELLED, "Cancelled.");
}
