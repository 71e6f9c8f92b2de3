#include "form/map.h"

#include "base/vec.h"

#include <string.h>

ax_sheet_map* ax_sheet_map_make(const ax_form* f)
{
    int n = f->lattice.linkage.hinge_count;
    ax_sheet_map* m = AX_NEW0(ax_sheet_map, 1);
    m->form = f;
    m->rim_hinges = AX_NEW(int, n);
    double(*places)[3] = ax_calloc((size_t)n, sizeof *places), (*rim)[3] = ax_alloc((size_t)n, sizeof *rim);
    for (int h = 0; h < n; ++h)
        memcpy(places[h], f->lattice.hinges[h], sizeof *f->lattice.hinges);
    m->cover = ax_linkage_cover(&f->lattice.linkage, (const double(*)[3])places);
    m->tree = ax_closest_make(&m->cover);
    m->rim_count = ax_linkage_rim(&f->lattice.linkage, m->rim_hinges);
    for (int k = 0; k < m->rim_count; ++k)
        memcpy(rim[k], places[m->rim_hinges[k]], sizeof *rim);
    m->rim = ax_polyline_make(m->rim_count, (const double(*)[3])rim);
    ax_free(rim);
    ax_free(places);
    return m;
}

void ax_sheet_map_free(ax_sheet_map* m)
{
    ax_closest_free(m->tree);
    ax_polyline_free(m->rim);
    ax_mesh_free(&m->cover);
    ax_free(m->rim_hinges);
    ax_free(m);
}

void ax_sheet_map_carry(const ax_sheet_map* m, const double (*values)[3], int count, const double (*places)[2],
                        double (*out)[3])
{
    ax_mesh values_cover = ax_linkage_cover(&m->form->lattice.linkage, values);
    int face = -1;
    for (int k = 0; k < count; ++k) {
        double at[3] = {places[k][0], places[k][1], 0}, ab[3], ac[3], ap[3];
        face = ax_closest_find(m->tree, at, face).face;
        const int* v = m->cover.faces[face];
        ax_sub3(m->cover.positions[v[1]], m->cover.positions[v[0]], ab);
        ax_sub3(m->cover.positions[v[2]], m->cover.positions[v[0]], ac);
        ax_sub3(at, m->cover.positions[v[0]], ap);
        double area = ax_cross2(ab, ac), b = ax_cross2(ap, ac) / area, c = ax_cross2(ab, ap) / area;
        for (int d = 0; d < 3; ++d)
            out[k][d] = (1 - b - c) * values_cover.positions[v[0]][d] + b * values_cover.positions[v[1]][d] +
                        c * values_cover.positions[v[2]][d];
    }
    ax_mesh_free(&values_cover);
}
