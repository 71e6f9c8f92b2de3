#include "picture/scene.h"

#include "base/vec.h"

#include <assert.h>

void ax_scene_free(ax_scene* scene)
{
    ax_free(scene->places);
    ax_free(scene->faces);
    ax_free(scene->face_paint);
    ax_free(scene->paints);
    ax_free(scene->normals);
    ax_free(scene->values);
    *scene = (ax_scene){0};
}

bool ax_scene_find_frame(int count, const double (*places)[3], ax_scene_frame* frame)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c) {
            if (!isfinite(places[i][c]))
                return false;
            lo[c] = fmin(lo[c], places[i][c]), hi[c] = fmax(hi[c], places[i][c]);
        }
    for (int c = 0; c < 3; ++c)
        frame->centre[c] = lo[c] + (hi[c] - lo[c]) / 2;
    double diagonal = ax_distance3(lo, hi);
    frame->size = diagonal > 0 ? diagonal : 1;
    return true;
}

int ax_scene_add_vertex(ax_scene* scene, const double place[3])
{
    if (scene->vertex_count == scene->vertex_capacity) {
        scene->vertex_capacity = 2 * scene->vertex_capacity + 1024;
        scene->places = ax_realloc(scene->places, (size_t)scene->vertex_capacity, sizeof *scene->places);
    }
    for (int c = 0; c < 3; ++c)
        scene->places[scene->vertex_count][c] = (float)place[c];
    return scene->vertex_count++;
}

int ax_scene_add_face(ax_scene* scene, int a, int b, int c, int paint)
{
    if (scene->face_count == scene->face_capacity) {
        scene->face_capacity = 2 * scene->face_capacity + 1024;
        scene->faces = ax_realloc(scene->faces, (size_t)scene->face_capacity, sizeof *scene->faces);
        scene->face_paint = ax_realloc(scene->face_paint, (size_t)scene->face_capacity, sizeof *scene->face_paint);
    }
    int* face = scene->faces[scene->face_count];
    face[0] = a, face[1] = b, face[2] = c;
    scene->face_paint[scene->face_count] = paint;
    return scene->face_count++;
}

int ax_scene_add_paint(ax_scene* scene, const double rgb[3], double gain)
{
    if (scene->paint_count == scene->paint_capacity) {
        scene->paint_capacity = 2 * scene->paint_capacity + 1024;
        scene->paints = ax_realloc(scene->paints, (size_t)scene->paint_capacity, sizeof *scene->paints);
    }
    ax_paint* paint = &scene->paints[scene->paint_count];
    *paint = (ax_paint){0};
    for (int c = 0; c < 3; ++c)
        paint->rgb[c] = (float)(gain * ax_colour_to_linear(rgb[c]));
    return scene->paint_count++;
}

ax_scene ax_scene_of_surface(const ax_mesh* mesh, const double* values, const ax_palette* palette, int front)
{
    ax_scene scene = {.palette = *palette, .two_sided = true};
    bool finite = ax_scene_find_frame(mesh->vertex_count, (const double(*)[3])mesh->positions, &scene.frame);
    assert(finite), (void)finite;
    double(*normals)[3] = ax_calloc((size_t)mesh->vertex_count, sizeof *normals);
    for (int v = 0; v < mesh->vertex_count; ++v) {
        double place[3];
        for (int c = 0; c < 3; ++c)
            place[c] = (mesh->positions[v][c] - scene.frame.centre[c]) / scene.frame.size;
        ax_scene_add_vertex(&scene, place);
    }
    for (int f = 0; f < mesh->face_count; ++f) {
        const int* corner = mesh->faces[f];
        double a[3], b[3], normal[3];
        for (int c = 0; c < 3; ++c) {
            a[c] = (mesh->positions[corner[1]][c] - mesh->positions[corner[0]][c]) / scene.frame.size;
            b[c] = (mesh->positions[corner[2]][c] - mesh->positions[corner[0]][c]) / scene.frame.size;
        }
        ax_cross(a, b, normal);
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c)
                normals[corner[k]][c] += front * normal[c];
        ax_scene_add_face(&scene, corner[0], corner[front > 0 ? 1 : 2], corner[front > 0 ? 2 : 1], 0);
    }
    scene.normals = ax_alloc((size_t)mesh->vertex_count, sizeof *scene.normals);
    scene.values = AX_NEW(float, mesh->vertex_count);
    for (int v = 0; v < mesh->vertex_count; ++v) {
        double length = ax_norm3(normals[v]);
        for (int c = 0; c < 3; ++c)
            scene.normals[v][c] = length > 0 ? (float)(normals[v][c] / length) : c == 2;
        scene.values[v] = (float)values[v];
    }
    ax_free(normals);
    return scene;
}
