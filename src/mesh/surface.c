#include "mesh/surface.h"

#include "base/vec.h"
#include "mesh/corners.h"
#include "mesh/geometry.h"
#include "mesh/topology.h"

#include <assert.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static const double weld_share = 1e-7; // of the diagonal

typedef struct work {
    ax_mesh* mesh;
    ax_vertex_order order;
    int *vertex_number, *face_number; // in the caller's order, for messages
    double tolerance;
    ax_mesh_repairs repairs;
    ax_error* error;
} work;

// --- words -----------------------------------------------------------------------------------------------------------

typedef struct words {
    char text[128];
} words;

static words at_point(const double x[3])
{
    words w;
    snprintf(w.text, sizeof w.text, "(%.7g, %.7g, %.7g)", x[0], x[1], x[2]);
    return w;
}

static words at_vertex(const work* k, int v)
{
    words point = at_point(k->mesh->positions[v]), w = point;
    if (k->order == AX_VERTICES_NUMBERED)
        snprintf(w.text, sizeof w.text, "vertex %d %.100s", k->vertex_number[v], point.text);
    return w;
}

static void face_centre(const ax_mesh* mesh, int face, double out[3])
{
    for (int d = 0; d < 3; ++d)
        out[d] = (mesh->positions[mesh->faces[face][0]][d] + mesh->positions[mesh->faces[face][1]][d] +
                  mesh->positions[mesh->faces[face][2]][d]) /
                 3;
}

static words at_face(const work* k, int f)
{
    double centre[3];
    face_centre(k->mesh, f, centre);
    words w;
    snprintf(w.text, sizeof w.text, "triangle %d (counted from 0) at %.90s", k->face_number[f], at_point(centre).text);
    return w;
}

// --- what was handed in ----------------------------------------------------------------------------------------------

static ax_status check_numbers(const work* k)
{
    const ax_mesh* mesh = k->mesh;
    if (mesh->face_count == 0)
        return ax_fail(
            k->error, AX_BAD_INPUT,
            "The mesh has no faces, only %d vertices. Give a surface of triangles or polygons; points and lines "
            "are not enough.",
            mesh->vertex_count);
    for (int f = 0; f < mesh->face_count; ++f)
        for (int c = 0; c < 3; ++c) {
            int v = mesh->faces[f][c];
            if (v < 0 || v >= mesh->vertex_count)
                return ax_fail(
                    k->error, AX_BAD_INPUT,
                    "Triangle %d (counted from 0) refers to vertex %d, but there are %d vertices, counted from 0. "
                    "Export the mesh again, or delete the face.",
                    f, v, mesh->vertex_count);
            const double* x = mesh->positions[v];
            if (!isfinite(x[0]) || !isfinite(x[1]) || !isfinite(x[2]))
                return ax_fail(
                    k->error, AX_BAD_INPUT,
                    "A corner of triangle %d (counted from 0), %s, is not at a finite place. Delete the triangle or "
                    "give its corners numbers.",
                    f, at_vertex(k, v).text);
        }
    return AX_OK;
}

// Products of four lengths must neither overflow nor vanish.
static ax_status check_size(work* k)
{
    const double least = 1e-60, most = 1e60;
    double lo[3], hi[3], diagonal = ax_diagonal(k->mesh);
    ax_bounds(k->mesh, lo, hi);
    if (!(diagonal > 0))
        return ax_fail(k->error, AX_BAD_INPUT,
                       "The mesh has no size: all its corners are at %s. Check the scale with which it was exported.",
                       at_point(lo).text);
    for (int d = 0; d < 3; ++d)
        if (!(fmax(fabs(lo[d]), fabs(hi[d])) < most))
            return ax_fail(
                k->error, AX_BAD_INPUT,
                "The mesh reaches from %s to %s, which is too large to compute with. Check the scale with which it "
                "was exported.",
                at_point(lo).text, at_point(hi).text);
    if (!(diagonal > least))
        return ax_fail(
            k->error, AX_BAD_INPUT,
            "The mesh at %s has a diagonal of only %g, which is too small to compute with. Check the scale with "
            "which it was exported.",
            at_point(lo).text, diagonal);
    k->tolerance = weld_share * diagonal;
    return AX_OK;
}

static void keep_faces(work* k, const unsigned char* dropped)
{
    ax_mesh* mesh = k->mesh;
    int kept = 0;
    for (int f = 0; f < mesh->face_count; ++f)
        if (!dropped[f]) {
            memmove(mesh->faces[kept], mesh->faces[f], sizeof *mesh->faces);
            k->face_number[kept++] = k->face_number[f];
        }
    mesh->face_count = kept;
}

static void drop_unused_vertices(work* k)
{
    ax_mesh* mesh = k->mesh;
    int* place = AX_NEW0(int, mesh->vertex_count);
    for (int f = 0; f < mesh->face_count; ++f)
        for (int c = 0; c < 3; ++c)
            place[mesh->faces[f][c]] = 1;
    int kept = 0;
    for (int v = 0; v < mesh->vertex_count; ++v)
        if (place[v]) {
            memmove(mesh->positions[kept], mesh->positions[v], sizeof *mesh->positions);
            k->vertex_number[kept] = k->vertex_number[v];
            place[v] = kept++;
        }
    for (int f = 0; f < mesh->face_count; ++f)
        for (int c = 0; c < 3; ++c)
            mesh->faces[f][c] = place[mesh->faces[f][c]];
    if (k->order != AX_VERTICES_SPLIT) // else they are the importer's
        k->repairs.unused_vertices += mesh->vertex_count - kept;
    mesh->vertex_count = kept;
    ax_free(place);
}

// --- welding ---------------------------------------------------------------------------------------------------------

static uint64_t mix(uint64_t a, uint64_t b, uint64_t c)
{
    uint64_t h = (a * 0x9e3779b97f4a7c15u ^ b) * 0xbf58476d1ce4e5b9u;
    h = (h ^ (h >> 29) ^ c) * 0x94d049bb133111ebu;
    return h ^ (h >> 32);
}

// Vertices that stay are more than the tolerance apart and sit in a hashed grid; each further vertex joins the one it
// finds within the tolerance. Cells are some tolerances wide, so that most vertices look into one cell and none holds
// many.
typedef struct grid {
    double origin[3], per_cell;
    uint64_t mask;
    int *head, *next;
} grid;

static int64_t cell_of(const grid* g, int d, double x)
{
    return (int64_t)floor((x - g->origin[d]) * g->per_cell);
}

static int find_near(const grid* g, const double (*positions)[3], const double x[3], double tolerance)
{
    int64_t lo[3], hi[3];
    for (int d = 0; d < 3; ++d) {
        lo[d] = cell_of(g, d, x[d] - tolerance);
        hi[d] = cell_of(g, d, x[d] + tolerance);
    }
    int found = -1;
    for (int64_t a = lo[0]; a <= hi[0]; ++a)
        for (int64_t b = lo[1]; b <= hi[1]; ++b)
            for (int64_t c = lo[2]; c <= hi[2]; ++c)
                for (int v = g->head[mix((uint64_t)a, (uint64_t)b, (uint64_t)c) & g->mask]; v >= 0; v = g->next[v])
                    if (ax_distance3(positions[v], x) <= tolerance && (found < 0 || v < found))
                        found = v;
    return found;
}

static void weld(work* k)
{
    ax_mesh* mesh = k->mesh;
    int n = mesh->vertex_count;
    uint64_t size = 1;
    while (size < (uint64_t)n)
        size *= 2;
    grid g = {.per_cell = 1 / (32 * k->tolerance), .mask = size - 1, .head = AX_NEW(int, size), .next = AX_NEW(int, n)};
    double hi[3];
    ax_bounds(mesh, g.origin, hi);
    memset(g.head, 0xff, size * sizeof *g.head);

    int* place = AX_NEW(int, n);
    int kept = 0;
    for (int v = 0; v < n; ++v) {
        double x[3] = {mesh->positions[v][0], mesh->positions[v][1], mesh->positions[v][2]};
        int near = find_near(&g, (const double(*)[3])mesh->positions, x, k->tolerance);
        if (near >= 0) {
            place[v] = near;
            bool repair = k->order != AX_VERTICES_SPLIT || memcmp(mesh->positions[near], x, sizeof x) != 0;
            k->repairs.welded_vertices += repair;
            continue;
        }
        uint64_t cell[3];
        for (int d = 0; d < 3; ++d) {
            cell[d] = (uint64_t)cell_of(&g, d, x[d]);
            mesh->positions[kept][d] = x[d];
        }
        uint64_t slot = mix(cell[0], cell[1], cell[2]) & g.mask;
        g.next[kept] = g.head[slot];
        g.head[slot] = kept;
        k->vertex_number[kept] = k->vertex_number[v];
        place[v] = kept++;
    }
    for (int f = 0; f < mesh->face_count; ++f)
        for (int c = 0; c < 3; ++c)
            mesh->faces[f][c] = place[mesh->faces[f][c]];
    mesh->vertex_count = kept;
    ax_free(place);
    ax_free(g.head);
    ax_free(g.next);
}

// --- faces without area ----------------------------------------------------------------------------------------------

static void drop_collapsed_faces(work* k)
{
    ax_mesh* mesh = k->mesh;
    unsigned char* dropped = AX_NEW0(unsigned char, mesh->face_count);
    for (int f = 0; f < mesh->face_count; ++f) {
        const int* v = mesh->faces[f];
        dropped[f] = v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
        k->repairs.degenerate_faces += dropped[f];
    }
    keep_faces(k, dropped);
    ax_free(dropped);
}

static const int crowded = -2;

// Pairs the sides of faces that share an edge, in whichever direction they run: -1 on the rim, `crowded` for the third
// and any further face at one edge. Returns the first crowded half-edge, or -1.
static int pair_sides(const ax_mesh* mesh, int* pair)
{
    ax_corners corners = ax_corners_make(mesh);
    int* first = AX_NEW(int, mesh->vertex_count); // side that joins v to each higher neighbour, else -1
    memset(first, 0xff, (size_t)mesh->vertex_count * sizeof *first);
    int fault = -1;
    for (int v = 0; v < mesh->vertex_count; ++v) {
        const int *begin = corners.corner + corners.start[v], *end = corners.corner + corners.start[v + 1];
        for (const int* c = begin; c < end; ++c) {
            int sides[2] = {ax_corner_before(*c), ax_corner_after(*c)};
            int others[2] = {ax_corner_vertex(mesh, sides[1]), ax_corner_vertex(mesh, sides[0])};
            for (int s = 0; s < 2; ++s) {
                int h = sides[s], w = others[s], g = first[w];
                if (w < v)
                    continue;
                pair[h] = -1;
                if (g < 0) {
                    first[w] = h;
                } else if (pair[g] == -1) {
                    pair[g] = h;
                    pair[h] = g;
                } else {
                    pair[h] = crowded;
                    fault = fault < 0 ? h : fault;
                }
            }
        }
        for (const int* c = begin; c < end; ++c) {
            first[ax_corner_vertex(mesh, ax_corner_before(*c))] = -1;
            first[ax_corner_vertex(mesh, ax_corner_after(*c))] = -1;
        }
    }
    ax_free(first);
    ax_corners_free(&corners);
    return fault;
}

// The side opposite the corner that lies on it, within the tolerance; -1 for a face with area.
static int flat_side(const work* k, int f)
{
    const ax_mesh* mesh = k->mesh;
    int longest = 0;
    double length = -1;
    for (int c = 0; c < 3; ++c) {
        int h = 3 * f + c;
        double l = ax_distance3(mesh->positions[ax_half_edge_from(mesh, h)], mesh->positions[ax_half_edge_to(mesh, h)]);
        if (l > length) {
            length = l;
            longest = h;
        }
    }
    return 2 * ax_face_area(mesh, f) <= k->tolerance * length ? longest : -1;
}

// A face whose corner lies on its opposite side cannot just go: it would leave a slit. The neighbour across that side
// is split at the corner instead, so that the surface stays the same; on the rim the face goes.
static bool mend_flat_face(ax_mesh* mesh, int h, const int* pair, unsigned char* touched, unsigned char* dropped)
{
    int f = h / 3, g = pair[h];
    if (touched[f] || g == crowded || (g >= 0 && touched[g / 3]))
        return false;
    touched[f] = 1;
    int corner = mesh->faces[f][h % 3];
    if (g < 0 || mesh->faces[g / 3][g % 3] == corner) {
        dropped[f] = 1;
        return true;
    }
    touched[g / 3] = 1;
    int from = ax_half_edge_from(mesh, g), to = ax_half_edge_to(mesh, g), top = mesh->faces[g / 3][g % 3];
    int *one = mesh->faces[f], *other = mesh->faces[g / 3];
    one[0] = corner, one[1] = to, one[2] = top;
    other[0] = from, other[1] = corner, other[2] = top;
    return true;
}

// One round: neighbours that have no area either wait for the next. True if anything changed.
static bool mend_round(work* k, const int* flat, int count)
{
    ax_mesh* mesh = k->mesh;
    int* pair = AX_NEW(int, 3 * mesh->face_count);
    unsigned char* touched = AX_NEW0(unsigned char, mesh->face_count);
    unsigned char* dropped = AX_NEW0(unsigned char, mesh->face_count);
    pair_sides(mesh, pair);
    int mended = 0;
    for (int i = 0; i < count; ++i)
        mended += mend_flat_face(mesh, flat[i], pair, touched, dropped);
    keep_faces(k, dropped);
    k->repairs.degenerate_faces += mended;
    ax_free(pair);
    ax_free(touched);
    ax_free(dropped);
    return mended > 0;
}

static ax_status mend_flat_faces(work* k)
{
    enum { most_rounds = 64 }; // a heap of faces within one line could pass a fault round for ever
    int* flat = AX_NEW(int, k->mesh->face_count);
    for (int round = 0;; ++round) {
        int count = 0;
        for (int f = 0; f < k->mesh->face_count; ++f) {
            int h = flat_side(k, f);
            if (h >= 0)
                flat[count++] = h;
        }
        if (count == 0)
            break;
        if (round == most_rounds || !mend_round(k, flat, count)) {
            ax_status status = ax_fail(
                k->error, AX_BAD_INPUT,
                "%d triangles have no area and cannot be taken out without tearing the surface, the first is %s. "
                "Delete them and close the gap.",
                count, at_face(k, flat[0] / 3).text);
            ax_free(flat);
            return status;
        }
    }
    ax_free(flat);
    return AX_OK;
}

static void sorted_corners(const int face[3], int out[3])
{
    int a = face[0], b = face[1], c = face[2], lo = a < b ? a : b, hi = a < b ? b : a;
    out[0] = c < lo ? c : lo;
    out[1] = c < lo ? lo : (c < hi ? c : hi);
    out[2] = c < hi ? hi : c;
}

static void drop_duplicate_faces(work* k)
{
    ax_mesh* mesh = k->mesh;
    uint64_t size = 1;
    while (size < 2 * (uint64_t)mesh->face_count)
        size *= 2;
    int* table = AX_NEW(int, size);
    memset(table, 0xff, size * sizeof *table);
    unsigned char* dropped = AX_NEW0(unsigned char, mesh->face_count);
    for (int f = 0; f < mesh->face_count; ++f) {
        int key[3], other[3];
        sorted_corners(mesh->faces[f], key);
        uint64_t slot = mix((uint64_t)key[0], (uint64_t)key[1], (uint64_t)key[2]) & (size - 1);
        for (; table[slot] >= 0 && !dropped[f]; slot = (slot + 1) & (size - 1)) {
            sorted_corners(mesh->faces[table[slot]], other);
            dropped[f] = memcmp(key, other, sizeof key) == 0;
        }
        if (!dropped[f])
            table[slot] = f;
        k->repairs.duplicate_faces += dropped[f];
    }
    keep_faces(k, dropped);
    ax_free(dropped);
    ax_free(table);
}

// --- one part, manifold, orientable ----------------------------------------------------------------------------------

static int root_of(int* parent, int v)
{
    while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
    return v;
}

static ax_status check_one_part(const work* k)
{
    const ax_mesh* mesh = k->mesh;
    int n = mesh->vertex_count;
    int *parent = AX_NEW(int, n), *faces = AX_NEW0(int, n);
    for (int v = 0; v < n; ++v)
        parent[v] = v;
    for (int f = 0; f < mesh->face_count; ++f)
        for (int c = 1; c < 3; ++c) {
            int a = root_of(parent, mesh->faces[f][0]), b = root_of(parent, mesh->faces[f][c]);
            parent[a > b ? a : b] = a > b ? b : a;
        }
    for (int f = 0; f < mesh->face_count; ++f)
        ++faces[root_of(parent, mesh->faces[f][0])];
    int parts = 0, largest = -1, second = -1;
    for (int v = 0; v < n; ++v) {
        if (parent[v] != v)
            continue;
        ++parts;
        if (largest < 0 || faces[v] > faces[largest]) {
            second = largest;
            largest = v;
        } else if (second < 0 || faces[v] > faces[second]) {
            second = v;
        }
    }
    ax_status status = AX_OK;
    if (parts > 1)
        status = ax_fail(
            k->error, AX_BAD_INPUT,
            "The mesh has %d separate parts: the largest has %d triangles, the second %d, at %s. Keep one part, "
            "or join the parts where they should meet (their corners must coincide there).",
            parts, faces[largest], faces[second], at_vertex(k, second).text);
    ax_free(faces);
    ax_free(parent);
    return status;
}

static ax_status crowded_edge(const work* k, int h)
{
    const ax_mesh* mesh = k->mesh;
    int from = ax_half_edge_from(mesh, h), to = ax_half_edge_to(mesh, h), count = 0, numbers[3] = {0};
    for (int f = 0; f < mesh->face_count; ++f) {
        int shared = 0;
        for (int c = 0; c < 3; ++c)
            shared += mesh->faces[f][c] == from || mesh->faces[f][c] == to;
        if (shared == 2 && count++ < 3)
            numbers[count - 1] = k->face_number[f];
    }
    return ax_fail(
        k->error, AX_BAD_INPUT,
        "%d triangles meet in one edge, from %s to %s: numbers %d, %d, %d%s (counted from 0). At most two can; "
        "delete the sheet that does not belong to the surface.",
        count, at_vertex(k, from).text, at_vertex(k, to).text, numbers[0], numbers[1], numbers[2],
        count > 3 ? " and others" : "");
}

static void turn(int face[3])
{
    int corner = face[1];
    face[1] = face[2];
    face[2] = corner;
}

// Walks from face to face and turns those that disagree with the first; if these are the most, it is the others that
// turn.
static ax_status orient(work* k, const int* pair)
{
    ax_mesh* mesh = k->mesh;
    int count = mesh->face_count, flipped = 0, conflict = -1;
    signed char* sign = AX_NEW0(signed char, count);
    int* queue = AX_NEW(int, count);
    for (int seed = 0; seed < count && conflict < 0; ++seed) {
        if (sign[seed])
            continue;
        int head = 0, tail = 0;
        queue[tail++] = seed;
        sign[seed] = 1;
        while (head < tail && conflict < 0) {
            int f = queue[head++];
            flipped += sign[f] < 0;
            for (int h = 3 * f; h < 3 * f + 3; ++h) {
                int g = pair[h];
                if (g < 0)
                    continue;
                signed char agree = ax_half_edge_from(mesh, h) == ax_half_edge_to(mesh, g) ? 1 : -1;
                if (!sign[g / 3]) {
                    sign[g / 3] = (signed char)(agree * sign[f]);
                    queue[tail++] = g / 3;
                } else if (sign[g / 3] != agree * sign[f]) {
                    conflict = h;
                }
            }
        }
    }
    ax_status status = AX_OK;
    if (conflict >= 0) {
        int from = ax_half_edge_from(mesh, conflict), to = ax_half_edge_to(mesh, conflict);
        status = ax_fail(
            k->error, AX_BAD_INPUT,
            "The surface has only one side, like a Moebius strip: walking round it turns it over, for example at "
            "the edge from %s to %s. Cut it open along a line across the strip.",
            at_vertex(k, from).text, at_vertex(k, to).text);
    } else {
        signed char wrong = 2 * flipped > count ? 1 : -1;
        for (int f = 0; f < count; ++f)
            if (sign[f] == wrong) {
                turn(mesh->faces[f]);
                ++k->repairs.flipped_faces;
            }
    }
    ax_free(queue);
    ax_free(sign);
    return status;
}

// Around a vertex of a surface the faces form one fan.
static ax_status check_fans(const work* k)
{
    const ax_mesh* mesh = k->mesh;
    ax_corners corners = ax_corners_make(mesh);
    int* pair = AX_NEW(int, 3 * mesh->face_count);
    pair_sides(mesh, pair);
    ax_status status = AX_OK;
    for (int v = 0; v < mesh->vertex_count && status == AX_OK; ++v) {
        int begin = corners.corner[corners.start[v]], size = 1;
        int c = begin;
        // the corner of v in the next face, counter-clockwise, then from the start clockwise
        for (int h; (h = pair[ax_corner_after(c)]) >= 0 && ax_corner_after(h) != begin; c = ax_corner_after(h))
            ++size;
        if (pair[ax_corner_after(c)] < 0)
            for (int h; (h = pair[ax_corner_before(begin)]) >= 0; begin = ax_corner_before(h))
                ++size;
        if (size != corners.start[v + 1] - corners.start[v])
            status = ax_fail(
                k->error, AX_BAD_INPUT,
                "The surface touches itself in one point: at %s, %d of %d triangles are joined to the others only "
                "there. Widen the contact to an edge, or part the surface there.",
                at_vertex(k, v).text, corners.start[v + 1] - corners.start[v] - size,
                corners.start[v + 1] - corners.start[v]);
    }
    ax_free(pair);
    ax_corners_free(&corners);
    return status;
}

// --- the rim ---------------------------------------------------------------------------------------------------------

static double loop_length(const ax_mesh* mesh, const ax_topology* topology, int loop)
{
    const int *begin = topology->loop + topology->loop_start[loop],
              *end = topology->loop + topology->loop_start[loop + 1];
    double length = 0;
    for (const int* v = begin; v < end; ++v)
        length += ax_distance3(mesh->positions[*v], mesh->positions[v + 1 < end ? v[1] : *begin]);
    return length;
}

static ax_status several_loops(const work* k, const ax_topology* topology)
{
    int rim = -1, inner = -1; // the longest and the second
    double rim_length = -1, inner_length = -1;
    for (int i = 0; i < topology->loop_count; ++i) {
        double length = loop_length(k->mesh, topology, i);
        if (length > rim_length) {
            inner = rim, inner_length = rim_length;
            rim = i, rim_length = length;
        } else if (length > inner_length) {
            inner = i, inner_length = length;
        }
    }
    return ax_fail(
        k->error, AX_CANNOT_REALISE,
        "The surface has %d boundary loops, and only surfaces with one can be realised so far: beside the rim, "
        "which is %.6g long, the longest is %.6g long, with %d edges, through %s. Fill the inner ones, or cut the "
        "surface into pieces with one rim each.",
        topology->loop_count, rim_length, inner_length, topology->loop_start[inner + 1] - topology->loop_start[inner],
        at_vertex(k, topology->loop[topology->loop_start[inner]]).text);
}

// Vertices - edges + faces is 2 - 2 handles - loops.
static ax_status check_kind(const work* k, const ax_topology* topology)
{
    const ax_mesh* mesh = k->mesh;
    double lo[3], hi[3];
    ax_bounds(mesh, lo, hi);
    if (topology->loop_count == 0)
        return ax_fail(
            k->error, AX_BAD_INPUT,
            "The surface is closed: it has no rim, between %s and %s. Cut it open, for example by deleting the "
            "triangles that rest on the ground.",
            at_point(lo).text, at_point(hi).text);
    if (topology->loop_count > 1)
        return several_loops(k, topology);
    int rim = topology->loop_start[1], edges = (3 * mesh->face_count + rim) / 2;
    int handles = (1 - (mesh->vertex_count - edges + mesh->face_count)) / 2;
    if (handles)
        return ax_fail(
            k->error, AX_CANNOT_REALISE,
            "The surface has %d %s, like that of a cup, between %s and %s, and only surfaces that a disk can be "
            "bent into can be realised so far. Remove it or cut the surface into pieces.",
            handles, handles == 1 ? "handle" : "handles", at_point(lo).text, at_point(hi).text);
    if (rim == mesh->vertex_count)
        return ax_fail(
            k->error, AX_BAD_INPUT,
            "The surface has %d %s and no vertex inside its rim, at %s, so it cannot bulge. It needs at least 3 "
            "triangles round an inner vertex, and some hundred to describe a shape: subdivide it.",
            mesh->face_count, mesh->face_count == 1 ? "triangle" : "triangles", at_vertex(k, 0).text);
    return AX_OK;
}

// The area vector of a surface is that of any other over the same rim; it looks out where it looks from the rim's
// middle towards the surface's. A surface that bulges to neither side looks up.
static void turn_outward(work* k, const ax_topology* topology)
{
    ax_mesh* mesh = k->mesh;
    const double* origin = mesh->positions[0];
    double vector[3] = {0}, middle[3] = {0}, rim_middle[3] = {0}, area = 0, rim_length = 0;
    for (int f = 0; f < mesh->face_count; ++f) {
        double a = ax_face_area(mesh, f), normal[3], centre[3];
        ax_face_normal(mesh, f, normal);
        face_centre(mesh, f, centre);
        area += a;
        for (int d = 0; d < 3; ++d) {
            vector[d] += a * normal[d];
            middle[d] += a * (centre[d] - origin[d]);
        }
    }
    int count = topology->loop_start[1];
    for (int i = 0; i < count; ++i) {
        const double *a = mesh->positions[topology->loop[i]], *b = mesh->positions[topology->loop[(i + 1) % count]];
        double length = ax_distance3(a, b);
        rim_length += length;
        for (int d = 0; d < 3; ++d)
            rim_middle[d] += length * (0.5 * (a[d] + b[d]) - origin[d]);
    }
    double rise[3];
    for (int d = 0; d < 3; ++d)
        rise[d] = middle[d] / area - rim_middle[d] / rim_length;
    double outward = ax_dot3(vector, rise);
    if (fabs(outward) <= 1e-4 * area * ax_diagonal(mesh))
        outward = vector[2];
    if (outward >= 0)
        return;
    for (int f = 0; f < mesh->face_count; ++f)
        turn(mesh->faces[f]);
    k->repairs.turned_outward = true;
}

// --- all of it -------------------------------------------------------------------------------------------------------

static ax_status check_manifold_and_orient(work* k)
{
    int* pair = AX_NEW(int, 3 * k->mesh->face_count);
    int fault = pair_sides(k->mesh, pair);
    ax_status status = fault >= 0 ? crowded_edge(k, fault) : orient(k, pair);
    ax_free(pair);
    return status == AX_OK ? check_fans(k) : status;
}

static ax_status check_rim_and_turn(work* k)
{
    ax_topology topology = ax_topology_make(k->mesh);
    ax_status status = check_kind(k, &topology);
    if (status == AX_OK)
        turn_outward(k, &topology);
    ax_topology_free(&topology);
    return status;
}

static ax_status make(work* k)
{
    ax_status status = check_numbers(k);
    if (status != AX_OK)
        return status;
    drop_unused_vertices(k);
    if ((status = check_size(k)) != AX_OK)
        return status;
    weld(k);
    drop_collapsed_faces(k);
    if ((status = mend_flat_faces(k)) != AX_OK)
        return status;
    drop_duplicate_faces(k);
    drop_unused_vertices(k);
    if (k->mesh->face_count == 0)
        return ax_fail(
            k->error, AX_BAD_INPUT,
            "All %d triangles of the mesh have no area: their corners lie on lines. Check the scale with which it "
            "was exported.",
            k->repairs.degenerate_faces);
    if ((status = check_one_part(k)) != AX_OK || (status = check_manifold_and_orient(k)) != AX_OK)
        return status;
    return check_rim_and_turn(k);
}

ax_status ax_surface_make(ax_mesh* mesh, ax_vertex_order order, ax_mesh_repairs* repairs, ax_error* error)
{
    work k = {.mesh = mesh, .order = order, .error = error};
    k.vertex_number = AX_NEW(int, mesh->vertex_count);
    k.face_number = AX_NEW(int, mesh->face_count);
    for (int v = 0; v < mesh->vertex_count; ++v)
        k.vertex_number[v] = v;
    for (int f = 0; f < mesh->face_count; ++f)
        k.face_number[f] = f;
    ax_status status = make(&k);
    if (status == AX_OK && repairs)
        *repairs = k.repairs;
    if (status == AX_OK) {
        mesh->positions = ax_realloc(mesh->positions, (size_t)mesh->vertex_count, sizeof *mesh->positions);
        mesh->faces = ax_realloc(mesh->faces, (size_t)mesh->face_count, sizeof *mesh->faces);
    } else {
        ax_mesh_free(mesh);
    }
    ax_free(k.vertex_number);
    ax_free(k.face_number);
    return status;
}

ax_status ax_mesh_make_surface(ax_mesh* mesh, ax_mesh_repairs* repairs, ax_error* error)
{
    assert(mesh && mesh->vertex_count >= 0 && mesh->face_count >= 0);
    return ax_surface_make(mesh, AX_VERTICES_NUMBERED, repairs, error);
}
