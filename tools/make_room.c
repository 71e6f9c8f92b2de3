// Writes the room of examples/cladding.json as reference geometry, room.obj and pipes.obj. usage: make_room FOLDER
//
// A room of 8.2 by 5.2 m, 3.4 m high, open to the viewer's side; a round column before the middle of one long wall; three
// pipes and a duct under the ceiling. Lengths are metres, the floor is z = 0, the origin its middle.
#include "base/vec.h"

#include "ax/mesh.h"

#include <stdio.h>
#include <string.h>

static const double wide = 8.2, deep = 5.2, high = 3.4; // of the room

typedef struct scene {
    FILE* out;
    int vertices;
} scene;

static void face(scene* s, int count, const double (*corner)[3])
{
    for (int k = 0; k < count; ++k)
        fprintf(s->out, "v %.9g %.9g %.9g\n", corner[k][0], corner[k][1], corner[k][2]);
    fprintf(s->out, "f");
    for (int k = 1; k <= count; ++k)
        fprintf(s->out, " %d", s->vertices + k);
    fprintf(s->out, "\n");
    s->vertices += count;
}

// A tube of `sides` faces round the straight line from a to b, without ends.
static void tube(scene* s, const double a[3], const double b[3], double radius, int sides)
{
    double axis[3], u[3], v[3];
    ax_sub3(b, a, axis);
    double other[3] = {axis[0] == 0, axis[0] != 0, 0};
    ax_cross(axis, other, u), ax_cross(axis, u, v);
    double lu = ax_norm3(u), lv = ax_norm3(v);
    for (int k = 0; k < sides; ++k) {
        double corner[4][3];
        for (int i = 0; i < 4; ++i) {
            double angle = 2 * AX_PI * (k + (i == 1 || i == 2)) / sides;
            const double* end = i < 2 ? a : b;
            for (int c = 0; c < 3; ++c) {
                corner[i][c] = end[c] + radius * (cos(angle) * u[c] / lu + sin(angle) * v[c] / lv);
                corner[i][c] = fabs(corner[i][c]) < 5e-10 ? 0 : corner[i][c];
            }
        }
        face(s, 4, (const double(*)[3])corner);
    }
}

static void room(scene* s)
{
    double x = wide / 2, y = deep / 2;
    face(s, 4, (const double[][3]){{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}});
    face(s, 4, (const double[][3]){{-x, y, 0}, {x, y, 0}, {x, y, high}, {-x, y, high}});
    face(s, 4, (const double[][3]){{-x, -y, 0}, {-x, y, 0}, {-x, y, high}, {-x, -y, high}});
    face(s, 4, (const double[][3]){{x, -y, 0}, {x, y, 0}, {x, y, high}, {x, -y, high}});
    tube(s, (const double[3]){1.1, 1.75, 0}, (const double[3]){1.1, 1.75, high}, 0.45, 32);
}

static void pipes(scene* s)
{
    double x = wide / 2, y = deep / 2;
    tube(s, (const double[3]){-x, -0.9, 3.12}, (const double[3]){x, -0.9, 3.12}, 0.09, 16);
    tube(s, (const double[3]){-x, -0.55, 3.12}, (const double[3]){x, -0.55, 3.12}, 0.06, 16);
    tube(s, (const double[3]){-x, 0.3, 3.16}, (const double[3]){x, 0.3, 3.16}, 0.16, 24);
    tube(s, (const double[3]){2.6, -y, 3.02}, (const double[3]){2.6, y, 3.02}, 0.05, 16);
}

static bool write_obj(const char* folder, const char* name, const char* words, void (*build)(scene*))
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.obj", folder, name);
    scene s = {.out = fopen(path, "w")};
    if (!s.out) {
        perror(path);
        return false;
    }
    fprintf(s.out, "# %s; metres\n", words);
    build(&s);
    return fclose(s.out) == 0;
}

int main(int argc, char** argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: make_room FOLDER\n");
        return 2;
    }
    return !(write_obj(argv[1], "room", "A room of 8.2 by 5.2 by 3.4 with a round column, open on one side", room) &&
             write_obj(argv[1], "pipes", "Pipes and a duct under the ceiling of that room", pipes));
}
