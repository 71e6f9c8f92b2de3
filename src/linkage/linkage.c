#include "ax/linkage.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void ax_linkage_free(ax_linkage* linkage)
{
    if (!linkage)
        return;
    ax_free(linkage->triangles);
    ax_free(linkage->panels);
    ax_free(linkage->hole_start);
    ax_free(linkage->hole_hinges);
    ax_free(linkage->opening_start);
    ax_free(linkage->opening_hinges);
    ax_free(linkage->on_rim);
    *linkage = (ax_linkage){0};
}

static int* copy_loops(const int* start, int count, const int* hinges, int** out_hinges)
{
    *out_hinges = start ? ax_copy(hinges, (size_t)start[count], sizeof *hinges) : NULL;
    return ax_copy(start, (size_t)count + 1, sizeof *start);
}

ax_linkage ax_linkage_copy(const ax_linkage* linkage)
{
    ax_linkage copy = *linkage;
    copy.triangles = ax_copy(linkage->triangles, (size_t)linkage->triangle_count, sizeof *linkage->triangles);
    copy.panels = ax_copy(linkage->panels, (size_t)linkage->triangle_count, sizeof *linkage->panels);
    copy.hole_start = copy_loops(linkage->hole_start, linkage->hole_count, linkage->hole_hinges, &copy.hole_hinges);
    copy.opening_start =
        copy_loops(linkage->opening_start, linkage->opening_count, linkage->opening_hinges, &copy.opening_hinges);
    copy.on_rim = ax_copy(linkage->on_rim, (size_t)linkage->hinge_count, sizeof *linkage->on_rim);
    return copy;
}

// The corners (3 triangle + k) that hold each hinge, -1 where there is no second one.
static ax_status hold_hinges(const ax_linkage* linkage, int (*held)[2], ax_error* error)
{
    memset(held, -1, (size_t)linkage->hinge_count * sizeof *held);
    for (int c = 0; c < 3 * linkage->triangle_count; ++c) {
        const int *corner = linkage->triangles[c / 3], *panel = linkage->panels[c / 3], h = corner[c % 3];
        if (h < 0 || h >= linkage->hinge_count)
            return ax_fail(error, AX_BAD_INPUT, "Triangle %d names hinge %d; there are %d hinges.", c / 3, h,
                           linkage->hinge_count);
        if (h == corner[(c + 1) % 3])
            return ax_fail(error, AX_BAD_INPUT, "Triangle %d names hinge %d twice.", c / 3, h);
        if (held[h][1] >= 0)
            return ax_fail(error, AX_BAD_INPUT, "Hinge %d is held by more than two triangles.", h);
        held[h][held[h][0] >= 0] = c;
        for (int d = 0; d < 2; ++d)
            if (panel[d] < -AX_PANEL_LIMIT || panel[d] > AX_PANEL_LIMIT || panel[2] < 0 || panel[2] > 1)
                return ax_fail(error, AX_BAD_INPUT, "Triangle %d has no place in the lattice.", c / 3);
    }
    for (int h = 0; h < linkage->hinge_count; ++h)
        if (held[h][0] < 0 || linkage->on_rim[h] != (held[h][1] < 0))
            return ax_fail(error, AX_BAD_INPUT, "Hinge %d is held by %d triangles and %s.", h,
                           (held[h][0] >= 0) + (held[h][1] >= 0),
                           linkage->on_rim[h] ? "marked as on the rim" : "not marked as on the rim");
    return AX_OK;
}

// The edge of a triangle from hinge `b` to hinge `a`, named by its first corner; -1 if there is none.
static int edge_between(const ax_linkage* linkage, const int (*held)[2], int b, int a)
{
    for (int s = 0; s < 2; ++s) {
        int c = held[b][s];
        if (c >= 0 && linkage->triangles[c / 3][(c + 1) % 3] == a)
            return c;
    }
    return -1;
}

// Follows all holes, or all openings, along the triangles; `met` marks the edges passed.
static ax_status follow_loops(const ax_linkage* linkage, bool closed, const int (*held)[2], unsigned char* met,
                              ax_error* error)
{
    int count = closed ? linkage->hole_count : linkage->opening_count;
    const int* start = closed ? linkage->hole_start : linkage->opening_start;
    const int* hinges = closed ? linkage->hole_hinges : linkage->opening_hinges;
    const char* name = closed ? "Hole" : "Opening";
    for (int k = 0; k < count; ++k) {
        const int *loop = hinges + start[k], length = start[k + 1] - start[k];
        for (int i = 0; i < length; ++i)
            if (loop[i] < 0 || loop[i] >= linkage->hinge_count)
                return ax_fail(error, AX_BAD_INPUT, "%s %d names hinge %d; there are %d hinges.", name, k, loop[i],
                               linkage->hinge_count);
        if (length < 3 || (!closed && !(linkage->on_rim[loop[0]] && linkage->on_rim[loop[length - 1]])))
            return ax_fail(error, AX_BAD_INPUT, "%s %d is too short or does not end on the rim.", name, k);
        for (int i = 0; i < length - !closed; ++i) {
            int a = loop[i], b = loop[(i + 1) % length], edge = edge_between(linkage, held, b, a);
            if (edge < 0 || met[edge])
                return ax_fail(error, AX_BAD_INPUT, "%s %d goes from hinge %d to %d, where no free edge leads.", name,
                               k, a, b);
            met[edge] = 1;
        }
    }
    return AX_OK;
}

ax_status ax_linkage_check(const ax_linkage* linkage, ax_error* error)
{
    int(*held)[2] = ax_alloc((size_t)linkage->hinge_count, sizeof *held);
    unsigned char* met = AX_NEW0(unsigned char, 3 * (size_t)linkage->triangle_count);
    ax_status status = hold_hinges(linkage, held, error);
    for (int closed = 1; closed >= 0 && status == AX_OK; --closed)
        status = follow_loops(linkage, closed, (const int(*)[2])held, met, error);
    for (int c = 0; c < 3 * linkage->triangle_count && status == AX_OK; ++c)
        if (!met[c])
            status =
                ax_fail(error, AX_BAD_INPUT, "Triangle %d has an edge that lies on no hole and no opening.", c / 3);
    ax_free(held);
    ax_free(met);
    return status;
}

int ax_linkage_rim(const ax_linkage* linkage, int* order)
{
    int n = linkage->hinge_count, count = 0;
    int* next = AX_NEW(int, n);
    memset(next, -1, (size_t)n * sizeof *next);
    int first = -1;
    for (int k = 0; k < linkage->opening_count; ++k) {
        int a = linkage->opening_hinges[linkage->opening_start[k]];
        next[a] = linkage->opening_hinges[linkage->opening_start[k + 1] - 1];
    }
    for (int t = 0; t < linkage->triangle_count; ++t) // a rim hinge and the next on the other side of a corner triangle
        for (int k = 0; k < 3; ++k) {
            int a = linkage->triangles[t][k], b = linkage->triangles[t][(k + 1) % 3];
            if (linkage->on_rim[a] && linkage->on_rim[b]) {
                if (next[b] < 0)
                    next[b] = a;
            }
        }
    for (int h = 0; h < n && first < 0; ++h)
        if (linkage->on_rim[h])
            first = h;
    for (int h = first; h >= 0 && count < n; h = next[h]) {
        order[count++] = h;
        if (next[h] == first)
            break;
    }
    ax_free(next);
    return count;
}

// Rows count A, B, ... Z, AA, ... from row 0 up and -A, -B, ... from row -1 down; places within a row 1, 2, ... and -1, -2, ...
// likewise. Names that were counted from the first row in use would change with every edit of the rim.
void ax_panel_name(const ax_linkage* linkage, int triangle, char text[16])
{
    assert(triangle >= 0 && triangle < linkage->triangle_count);
    const int* panel = linkage->panels[triangle];
    int row = panel[1], place = 2 * panel[0] + panel[2];
    assert(abs(row) <= AX_PANEL_LIMIT && abs(panel[0]) <= AX_PANEL_LIMIT); // else the text is too short
    char letters[8];
    char* first = letters + sizeof letters - 1;
    *first = '\0';
    for (int n = row < 0 ? -row : row + 1; n > 0; n = (n - 1) / 26) // bijective base 26: after Z comes AA
        *--first = (char)('A' + (n - 1) % 26);
    snprintf(text, 16, "%s%s%d", row < 0 ? "-" : "", first, place < 0 ? place : place + 1);
}

static int loops_end(const int* start, int count)
{
    return count ? start[count] : 0;
}

ax_mesh ax_linkage_cover(const ax_linkage* l, const double (*hinges)[3])
{
    int n = l->hinge_count;
    int most =
        l->triangle_count + loops_end(l->hole_start, l->hole_count) + loops_end(l->opening_start, l->opening_count);
    ax_mesh mesh = {.vertex_count = n + l->hole_count};
    mesh.positions = ax_calloc((size_t)mesh.vertex_count, sizeof *mesh.positions);
    mesh.faces = ax_alloc((size_t)most, sizeof *mesh.faces);
    memcpy(mesh.positions, hinges, (size_t)n * sizeof *hinges);
    memcpy(mesh.faces, l->triangles, (size_t)l->triangle_count * sizeof *mesh.faces);
    mesh.face_count = l->triangle_count;
    for (int k = 0; k < l->hole_count; ++k) {
        const int* loop = l->hole_hinges + l->hole_start[k];
        int count = l->hole_start[k + 1] - l->hole_start[k];
        for (int i = 0; i < count; ++i) {
            for (int c = 0; c < 3; ++c)
                mesh.positions[n + k][c] += hinges[loop[i]][c] / count;
            memcpy(mesh.faces[mesh.face_count++], (int[3]){loop[i], loop[(i + 1) % count], n + k}, sizeof *mesh.faces);
        }
    }
    for (int k = 0; k < l->opening_count; ++k) {
        const int* loop = l->opening_hinges + l->opening_start[k];
        for (int i = 1; i + 1 < l->opening_start[k + 1] - l->opening_start[k]; ++i)
            memcpy(mesh.faces[mesh.face_count++], (int[3]){loop[0], loop[i], loop[i + 1]}, sizeof *mesh.faces);
    }
    return mesh;
}
