// Awkward meshes, written to a temporary folder, each with what reading it must lead to. Whatever reads meshes is fed
// all of them.
#pragma once

#include "ax/mesh.h"

typedef struct zoo_animal {
    char path[96];
    ax_status expected;      // of ax_mesh_read, and hence the exit code of a command
    const char* word;        // the message must contain it; NULL when reading succeeds
    ax_mesh_repairs repairs; // when reading succeeds: exactly these
} zoo_animal;

typedef struct zoo {
    char folder[32];
    int count;
    zoo_animal* animals;
} zoo;

void zoo_open(zoo* all);
void zoo_close(zoo* all); // removes the files and the folder

// One mesh as a file. Formats: "obj", "off", "ply" and "stl" (text, 17 digits, in STL 9), "ply binary" and "stl binary"
// (floats).
void zoo_write(const char* path, const char* format, const ax_mesh* mesh);
