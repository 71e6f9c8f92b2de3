// How a mesh travels from the process that parses a file to the one that uses it: the header below, then vertex_count
// times three doubles, then face_count times three 32-bit integers, then `end`. Both ends are built together and run on
// one machine, so numbers have its own byte order; but the sender has read an untrusted file, so the receiver trusts no
// field.
#pragma once

#include "mesh/surface.h"

#include <stdint.h>

typedef struct ax_stream_header {
    char magic[8];
    uint32_t order; // ax_vertex_order
    uint32_t unused;
    uint64_t vertex_count, face_count;
} ax_stream_header;

static const char ax_stream_magic[8] = "axmesh1";
static const char ax_stream_end[8] = "the end";

// More than anybody has designed with, and within what the limits on memory and 32-bit indices allow.
enum { ax_stream_most_faces = 20000000, ax_stream_most_vertices = 3 * ax_stream_most_faces };

// Exit codes of the reader.
enum { ax_reader_done = 0, ax_reader_failed = 1, ax_reader_bad_input = 3 };

// Receives a mesh from `take`, which fills `into` completely or returns false. False if the stream breaks off or is not
// one.
bool ax_stream_receive(bool (*take)(void* context, void* into, size_t bytes), void* context, ax_mesh* mesh,
                       ax_vertex_order* order);
