#include "operator/operator.h"

#include <stdio.h>

const ax_operator_type* ax_operator_find(const char* name)
{
    int count;
    const ax_operator_type* const* types = ax_operator_types(&count);
    for (int k = 0; k < count; ++k)
        if (strcmp(types[k]->name, name) == 0)
            return types[k];
    return NULL;
}

char* ax_operator_path(const ax_operator_context* context, const char* name)
{
    if (context->file)
        return ax_copy_text(context->file);
    const char* folder = context->folder && *context->folder ? context->folder : ".";
    size_t size = strlen(folder) + strlen(name) + 2;
    char* path = AX_NEW(char, size);
    if (*name == '/')
        snprintf(path, size, "%s", name);
    else
        snprintf(path, size, "%s/%s", folder, name);
    return path;
}

ax_status ax_operator_hinges(const ax_operator_context* context, const char* words, int fewest, int** hinges,
                             int* count, ax_error* error)
{
    ax_status status = ax_select(*context->form, words, hinges, count, error);
    if (status == AX_OK && *count < fewest) {
        status =
            ax_fail(error, AX_BAD_INPUT, "\"%s\" chooses %d hinges; at least %d are needed.", words, *count, fewest);
        ax_free(*hinges);
        *hinges = NULL;
    }
    return status;
}

static void choose_panels(const ax_linkage* linkage, const int* hinges, int count, unsigned char* chosen)
{
    unsigned char* is_chosen = AX_NEW0(unsigned char, linkage->hinge_count);
    for (int k = 0; k < count; ++k)
        is_chosen[hinges[k]] = 1;
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* corner = linkage->triangles[t];
        chosen[t] = is_chosen[corner[0]] & is_chosen[corner[1]] & is_chosen[corner[2]];
    }
    ax_free(is_chosen);
}

ax_status ax_sheet_take(const ax_operator_context* context, const char* words, ax_sheet* sheet, ax_error* error)
{
    *sheet = (ax_sheet){0};
    int *hinges, count;
    ax_status status = ax_operator_hinges(context, words, 3, &hinges, &count, error);
    if (status != AX_OK)
        return status;
    ax_form_view view = ax_form_look(*context->form);
    const ax_linkage* linkage = view.linkage;
    int n = linkage->triangle_count;
    *sheet = (ax_sheet){.linkage = linkage,
                        .spacing = view.spacing,
                        .count = n,
                        .centre = ax_alloc((size_t)n, sizeof *sheet->centre),
                        .scale = ax_copy(view.prescribed, (size_t)n, sizeof(double)),
                        .chosen = AX_NEW(unsigned char, n),
                        .lo = {INFINITY, INFINITY},
                        .hi = {-INFINITY, -INFINITY}};
    choose_panels(linkage, hinges, count, sheet->chosen);
    ax_free(hinges);
    for (int t = 0; t < n; ++t)
        for (int d = 0; d < 2; ++d) {
            const int* corner = linkage->triangles[t];
            sheet->centre[t][d] = (view.sheet[corner[0]][d] + view.sheet[corner[1]][d] + view.sheet[corner[2]][d]) / 3;
        }
    for (int h = 0; h < linkage->hinge_count; ++h)
        for (int d = 0; d < 2; ++d) {
            sheet->lo[d] = fmin(sheet->lo[d], view.sheet[h][d]);
            sheet->hi[d] = fmax(sheet->hi[d], view.sheet[h][d]);
        }
    for (int d = 0; d < 2; ++d)
        sheet->middle[d] = (sheet->lo[d] + sheet->hi[d]) / 2;
    return AX_OK;
}

void ax_sheet_free(ax_sheet* sheet)
{
    ax_free(sheet->centre);
    ax_free(sheet->scale);
    ax_free(sheet->chosen);
    *sheet = (ax_sheet){0};
}

void ax_sheet_give(const ax_operator_context* context, ax_sheet* sheet)
{
    ax_form_prescribe(*context->form, sheet->scale);
    ax_sheet_free(sheet);
}
