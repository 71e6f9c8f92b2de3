// auxshell check: can this surface become a deployable linkage?
#include "options.h"
#include "output.h"
#include "progress.h"
#include "report.h"

#include "ax/picture.h"

#include <limits.h>
#include <math.h>
#include <string.h>

typedef struct arguments {
    const char* target;
    bool json;
    int up, units; // units: 0 unless given, then ax_unit + 1
    double scale[2];
    const char *png, *nearest;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    const ax_target_options usual = ax_target_options_default();
    a->scale[0] = usual.scale_lo, a->scale[1] = usual.scale_hi;
}

static const command_option options[] = {
    {.name = "TARGET",
     .text = "the surface: OBJ, STL, PLY, OFF or another mesh format",
     .kind = OPTION_TEXT,
     .operand = true,
     .required = true,
     .offset = offsetof(arguments, target)},
    OPTION_UP(arguments, up),
    OPTION_UNITS(arguments, units, .first = AX_MILLIMETRE + 1, .fallback = "that of the file, whatever it is"),
    OPTION_SCALE(arguments, scale),
    {.name = "--json", .text = "print every figure as JSON", .kind = OPTION_FLAG, .offset = offsetof(arguments, json)},
    {.name = "--png",
     .value = "DIR",
     .text = "write pictures of the mean curvature and of the scale factors: DIR/curvature.png and DIR/scale.png",
     .kind = OPTION_TEXT,
     .offset = offsetof(arguments, png)},
    {.name = "--nearest",
     .value = "FILE.obj",
     .text = "write the nearest surface that bulges outwards, for which design --project designs",
     .kind = OPTION_TEXT,
     .offset = offsetof(arguments, nearest)},
};

static const char* const verdict_names[] = {
    [AX_DEPLOYABLE] = "deployable",
    [AX_DEPLOYABLE_PROJECTED] = "deployable after projection",
    [AX_NOT_DEPLOYABLE] = "not deployable",
};

// Zero instead of what rounding has left of it.
static double tidy(double x, double size)
{
    return fabs(x) < 1e-9 * size ? 0 : x;
}

static void print_screen(const arguments* a, const ax_mesh* mesh, const ax_mesh_repairs* repairs, const ax_screen* s)
{
    const double flat = 1 / s->diagonal, *worst = s->curvature_worst_place;
    double size[3];
    for (int c = 0; c < 3; ++c)
        size[c] = s->bounds[1][c] - s->bounds[0][c];
    printf("%s\n", a->target);
    printf("  Mesh            %d vertices, %d faces, %d vertices on the rim\n", mesh->vertex_count, mesh->face_count,
           s->rim_count);
    printf("  Mended          ");
    repairs_print(repairs, stdout);
    printf("  Size            %.5g x %.5g x %.5g; area %.5g, rim %.5g, in %s\n", size[0], size[1], size[2], s->area,
           s->rim_length, a->units ? ax_unit_name((ax_unit)(a->units - 1)) : "the file's unit");
    printf("  Mean curvature  median %.4g, smallest %.4g, 1 %% below %.4g, 5 %% above %.4g\n",
           tidy(s->curvature_median, flat), tidy(s->curvature_min, flat), tidy(s->curvature_q01, flat),
           tidy(s->curvature_q95, flat));
    if (s->curvature_nonpositive_share > 0)
        printf("  H <= 0          on %.1f %% of the area, around (%.5g, %.5g, %.5g)\n",
               100 * s->curvature_nonpositive_share, tidy(worst[0], s->diagonal), tidy(worst[1], s->diagonal),
               tidy(worst[2], s->diagonal));
    else
        printf("  H <= 0          nowhere\n");
    if (s->height_field && tidy(s->curvature_median, flat) <= 0)
        printf("  Height field    yes\n");
    else if (s->height_field)
        printf("  Height field    yes, it bulges towards %cz\n", s->gravity_direction < 0 ? '-' : '+');
    else
        printf("  Height field    no: parts of it lie above others, so that gravity cannot deploy it\n");
    if (isfinite(s->scale_ratio))
        printf("  Scale factors   a range of %.4f is needed: %.4f to %.4f%s\n", s->scale_ratio, s->scale_lo,
               s->scale_hi, s->scale_fits ? "" : ", outside the band: it needs cones or several pieces");
    printf("  Deploys         %s%s\n",
           s->by_inflation && s->by_gravity ? "by inflation and by gravity"
           : s->by_inflation                ? "by inflation"
           : s->by_gravity                  ? "by gravity"
                                            : "not",
           s->verdict == AX_DEPLOYABLE_PROJECTED ? ", after projection" : "");
    printf("  Verdict         ");
    print_wrapped(stdout, 18, 18, s->words);
}

static json_t* screen_json(const ax_mesh* mesh, const ax_mesh_repairs* repairs, const ax_screen* s)
{
    json_t* curvature = json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o}", "min", json_number(s->curvature_min), "q01", json_number(s->curvature_q01),
        "median", json_number(s->curvature_median), "q95", json_number(s->curvature_q95), "nonpositive_share",
        json_number(s->curvature_nonpositive_share), "worst_place", json_numbers(s->curvature_worst_place, 3));
    json_t* scale = json_pack("{s:o, s:o, s:o, s:b, s:b}", "ratio", json_number(s->scale_ratio), "min",
                              json_number(s->scale_lo), "max", json_number(s->scale_hi), "fits", (int)s->scale_fits,
                              "needs_cones", (int)(isfinite(s->scale_ratio) && !s->scale_fits));
    return json_pack("{s:s, s:s, s:i, s:i, s:i, s:o, s:o, s:o, s:o, s:o, s:o, s:b, s:b, s:o, s:b, s:b, s:o}", "verdict",
                     verdict_names[s->verdict], "words", s->words, "vertices", mesh->vertex_count, "faces",
                     mesh->face_count, "rim_vertices", s->rim_count, "rim_length", json_number(s->rim_length), "area",
                     json_number(s->area), "diagonal", json_number(s->diagonal), "bounds",
                     json_pack("[o, o]", json_numbers(s->bounds[0], 3), json_numbers(s->bounds[1], 3)), "curvature",
                     curvature, "scale", scale, "height_field", (int)s->height_field, "lies_on_side",
                     (int)s->lies_on_side, "gravity_direction", json_number(s->gravity_direction), "by_inflation",
                     (int)s->by_inflation, "by_gravity", (int)s->by_gravity, "repairs", repairs_json(repairs));
}

static ax_status draw(const arguments* a, const ax_mesh* mesh, const ax_screen* screen, ax_error* error)
{
    char path[PATH_MAX];
    ax_status status = output_make_folder(a->png, error);
    if (status == AX_OK)
        status = output_join(a->png, "curvature.png", path, sizeof path, error);
    if (status == AX_OK)
        status = ax_picture_screen(mesh, screen, AX_SCREEN_CURVATURE, 1600, 1200, path, error);
    if (status == AX_OK)
        status = output_join(a->png, "scale.png", path, sizeof path, error);
    if (status == AX_OK && screen->scale)
        status = ax_picture_screen(mesh, screen, AX_SCREEN_SCALE, 1600, 1200, path, error);
    return status;
}

// The surface itself, if it deploys; NULL if no part of it bulges outwards.
static const ax_mesh* nearest_of(const ax_mesh* mesh, const ax_screen* screen)
{
    if (screen->nearest.face_count)
        return &screen->nearest;
    return screen->verdict == AX_DEPLOYABLE ? mesh : NULL;
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_target_options wanted = ax_target_options_default();
    wanted.scale_lo = a->scale[0], wanted.scale_hi = a->scale[1];
    ax_mesh mesh = {0};
    ax_mesh_repairs repairs;
    ax_screen screen = {0};
    ax_read_options read = ax_read_options_default();
    read.up = (ax_up)a->up;
    ax_status status = a->png ? output_check_folder(a->png, error) : AX_OK;
    if (status == AX_OK && a->nearest)
        status = output_check(a->nearest, ".obj", error);
    if (status == AX_OK)
        status = ax_mesh_read(a->target, &read, &mesh, &repairs, error);
    if (status == AX_OK)
        status = ax_target_screen(&mesh, &wanted, progress_reporter(), &screen, error);
    progress_end();
    if (status == AX_OK && a->png)
        status = draw(a, &mesh, &screen, error);
    const ax_mesh* nearest = a->nearest ? nearest_of(&mesh, &screen) : NULL;
    if (status == AX_OK && nearest)
        status = ax_mesh_write(nearest, a->nearest, error);
    if (status == AX_OK) {
        if (a->json)
            json_print(screen_json(&mesh, &repairs, &screen), stdout);
        else
            print_screen(a, &mesh, &repairs, &screen);
        if (a->nearest && !a->json)
            printf(nearest ? "Wrote %s\n" : "Wrote no %s: there is no such surface\n", a->nearest);
        if (screen.verdict == AX_NOT_DEPLOYABLE)
            status = AX_CANNOT_REALISE;
    }
    ax_screen_free(&screen);
    ax_mesh_free(&mesh);
    return status;
}

const command command_check = {
    .name = "check",
    .summary = "tell whether a surface can become a deployable linkage",
    .text = "Screens a target surface: faults of the mesh, mean curvature, the range of scale factors that a conformal "
            "map needs, and by which load it deploys. Ends with 0 if it deploys as it is or after projection, with 4 "
            "if not.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
};
