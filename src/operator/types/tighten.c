#include "operator/scale_field.h"

typedef struct arguments {
    int rounds;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->rounds = 3;
}

static const ax_field fields[] = {
    AX_INTEGER(arguments, rounds, "Rounds", 1, 20,
               .doc = "Each brings the loaded shape closer to the designed one and makes it flatter."),
};

// Per panel the mean opening of its holes, and the scale factors that follow: slack panels get smaller, by no more than a quarter a
// round, and neighbours go along.
static void tighten_once(ax_form* form)
{
    ax_form_view view = ax_form_look(form);
    const double* open = ax_form_opening(form);
    const ax_linkage* l = view.linkage;
    int n = l->triangle_count;
    double *opening = AX_NEW0(double, l->hinge_count), *u = AX_NEW(double, n);
    int* holes = AX_NEW0(int, l->hinge_count);
    unsigned char* chosen = AX_NEW(unsigned char, n);
    memset(chosen, 1, (size_t)n);
    for (int k = 0; k < l->hole_count; ++k)
        for (int i = l->hole_start[k]; i < l->hole_start[k + 1]; ++i) {
            opening[l->hole_hinges[i]] += open[k];
            ++holes[l->hole_hinges[i]];
        }
    for (int t = 0; t < n; ++t) {
        double sum = 0;
        int count = 0;
        for (int k = 0; k < 3; ++k) {
            sum += opening[l->triangles[t][k]];
            count += holes[l->triangles[t][k]];
        }
        double mean = count ? sum / count : 1;
        u[t] = log(view.prescribed[t]) + 0.5 * log(ax_clamp(mean, 0.6, 1));
    }
    ax_field_smooth(l, view.spacing, chosen, view.spacing / 2, u);
    for (int t = 0; t < n; ++t)
        u[t] = ax_clamp(exp(u[t]), 1, fmin(view.prescribed[t], 1.9)); // never looser
    ax_form_prescribe(form, u);
    ax_free(opening);
    ax_free(u);
    ax_free(holes);
    ax_free(chosen);
}

static ax_status run(ax_form* form, int rounds, const ax_progress* progress, ax_error* error)
{
    ax_status status = AX_OK;
    for (int k = 0; k < rounds && status == AX_OK; ++k) {
        ax_progress_part part;
        tighten_once(form);
        status =
            ax_form_settle(form, 0, ax_progress_within(&part, progress, (double)k / rounds, (k + 1.0) / rounds), error);
    }
    return status;
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_form** form = context->form;
    ax_dynamics_kind kind = ax_form_get_dynamics(*form)->kind;
    if (kind != AX_DYNAMICS_GRAVITY && kind != AX_DYNAMICS_INFLATION)
        return ax_fail(error, AX_BAD_INPUT, "There is no load to hold: put gravity or inflation before it.");
    if (context->live) {
        tighten_once(*form);
        return AX_OK;
    }
    size_t size;
    void* before = ax_form_save(*form, &size);
    ax_status status = run(*form, a->rounds, context->progress, error);
    if (status != AX_OK) {
        ax_form_free(*form);
        *form = NULL;
        ax_form_load(before, size, form, NULL);
    }
    ax_free(before);
    return status;
}

const ax_operator_type ax_operator_tighten = {
    .name = "tighten",
    .title = "Tighten to load",
    .doc = "Lowers scale factors where holes are slack under the load, until the painted design holds: rounds of "
           "settling, measuring the openings, and painting.",
    .group = "dynamics",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .apply = apply,
};
